#include "terrain/png/png.h"

#include <png.h>

#include <array>
#include <csetjmp>
#include <cstdio>
#include <cstring>

#include "terrain/require.h"

// libpng leaves its functions by longjmp when it meets an error. Whatever calls
// it therefore sets the place to return to in a function of its own, in which
// nothing with a destructor lives.

namespace terra {
namespace {

constexpr std::string_view kSignature("\x89PNG\r\n\x1a\n", 8);

std::size_t RowBytes(int width, PixelOrder order) {
  return static_cast<std::size_t>(width) *
         static_cast<std::size_t>(BytesPerPixel(order));
}

void IgnoreWarning(png_structp /*png*/, png_const_charp /*message*/) {}

// Reads a PNG in memory.
class Reader {
 public:
  explicit Reader(std::string_view bytes)
      : left_(bytes),
        png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, this, KeepError,
                                    IgnoreWarning)),
        info_(png_create_info_struct(png_)) {
    TERRA_REQUIRE(png_ != nullptr && info_ != nullptr);
  }
  ~Reader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  // All before the pixels.
  bool ReadHeader() {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    // Texts, profiles and the like are passed over unread.
    png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
    png_set_read_fn(png_, this, TakeBytes);
    png_read_info(png_, info_);
    return true;
  }

  // The pixels and all behind them.
  bool ReadPixels(png_bytep* rows) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_read_image(png_, rows);
    png_read_end(png_, nullptr);
    return true;
  }

  // After the header: how ReadRows is to give the pixels.
  bool Expand() {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_set_expand(png_);
    png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    return true;
  }

  // Needs a buffer of one row.
  bool ReadRows(const PngForm& form, png_bytep row, const TakePngRow& take) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    for (int y = 0; y < form.height; ++y) {
      png_read_row(png_, row, nullptr);
      take(form, y, row);
    }
    png_read_end(png_, nullptr);
    return true;
  }

  std::int64_t width() const { return png_get_image_width(png_, info_); }
  std::int64_t height() const { return png_get_image_height(png_, info_); }
  int bit_depth() const { return png_get_bit_depth(png_, info_); }
  int color_type() const { return png_get_color_type(png_, info_); }
  int channels() const { return png_get_channels(png_, info_); }
  bool interlaced() const {
    return png_get_interlace_type(png_, info_) != PNG_INTERLACE_NONE;
  }
  // As stored, or after Expand as given.
  std::size_t row_bytes() const { return png_get_rowbytes(png_, info_); }
  bool has_transparent_color() const {
    return png_get_valid(png_, info_, PNG_INFO_tRNS) != 0;
  }

  /// After a failure: did the bytes end too early?
  bool ran_out() const { return ran_out_; }
  const char* error() const { return error_.data(); }

 private:
  [[noreturn]] static void KeepError(png_structp png, png_const_charp message) {
    auto& reader = *static_cast<Reader*>(png_get_error_ptr(png));
    std::snprintf(reader.error_.data(), reader.error_.size(), "%s", message);
    png_longjmp(png, 1);
  }

  static void TakeBytes(png_structp png, png_bytep out, std::size_t count) {
    auto& reader = *static_cast<Reader*>(png_get_io_ptr(png));
    if (reader.left_.size() < count) {
      reader.ran_out_ = true;
      png_error(png, "no more bytes");
    }
    std::memcpy(out, reader.left_.data(), count);
    reader.left_.remove_prefix(count);
  }

  std::string_view left_;
  bool ran_out_ = false;
  std::array<char, 80> error_{};
  png_structp png_;
  png_infop info_;
};

// Writes a PNG into memory.
class Writer {
 public:
  Writer()
      : png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr,
                                     IgnoreWarning)),
        info_(png_create_info_struct(png_)) {
    TERRA_REQUIRE(png_ != nullptr && info_ != nullptr);
  }
  ~Writer() { png_destroy_write_struct(&png_, &info_); }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  // False only when memory ran out.
  bool Write(const PixelView& pixels, PngEffort effort) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_set_write_fn(png_, &bytes_, AddBytes, nullptr);
    if (effort == PngEffort::kFast) {
      // Maps are large areas of one colour: runs are most of what there is.
      png_set_filter(png_, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
      png_set_compression_level(png_, kFastestLevel);
      png_set_compression_strategy(png_, kRunLengths);
    } else {
      png_set_compression_level(png_, kSmallestLevel);
    }
    const bool grey = pixels.order == PixelOrder::kGrey;
    png_set_IHDR(png_, info_, static_cast<png_uint_32>(pixels.width),
                 static_cast<png_uint_32>(pixels.height), 8,
                 grey ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png_, info_);
    if (pixels.order == PixelOrder::kBgr) png_set_bgr(png_);
    const std::size_t row_bytes = RowBytes(pixels.width, pixels.order);
    for (int y = 0; y < pixels.height; ++y) {
      png_write_row(png_,
                    pixels.bytes + static_cast<std::size_t>(y) * row_bytes);
    }
    png_write_end(png_, info_);
    return true;
  }

  std::string& bytes() { return bytes_; }

 private:
  // Of zlib.
  static constexpr int kFastestLevel = 1;
  static constexpr int kSmallestLevel = 9;
  static constexpr int kRunLengths = 3;

  static void AddBytes(png_structp png, png_bytep bytes,
                       std::size_t count) noexcept {
    static_cast<std::string*>(png_get_io_ptr(png))
        ->append(reinterpret_cast<const char*>(bytes), count);
  }

  std::string bytes_;
  png_structp png_;
  png_infop info_;
};

Error Damaged(const std::string& name, const Reader& reader) {
  return Error{ErrorCode::kInvalid,
               name +
                   (reader.ran_out() ? ": the PNG is truncated"
                                     : std::string(": the PNG is damaged (") +
                                           reader.error() + ")") +
                   "; copy the file again"};
}

// Says what is not taken; empty for 8-bit grey and 24-bit colour.
std::string WhyNotTaken(const Reader& reader) {
  if (reader.color_type() == PNG_COLOR_TYPE_PALETTE) return "a palette";
  if (reader.color_type() != PNG_COLOR_TYPE_GRAY &&
      reader.color_type() != PNG_COLOR_TYPE_RGB) {
    return "an alpha channel";
  }
  if (reader.has_transparent_color()) return "a transparent colour";
  if (reader.bit_depth() != 8) {
    return std::to_string(reader.bit_depth()) + " bits per channel";
  }
  return "";
}

Status CheckSize(const Reader& reader, int max_side, const std::string& name) {
  if (reader.width() > max_side || reader.height() > max_side) {
    return Error{ErrorCode::kUnsupported,
                 name + ": " + std::to_string(reader.width()) + " x " +
                     std::to_string(reader.height()) + " pixels; 1 to " +
                     std::to_string(max_side) +
                     " a side are taken: cut it into parts or lower its "
                     "resolution"};
  }
  return Done{};
}

Status CheckKind(const Reader& reader, const std::string& name) {
  const std::string refusal = WhyNotTaken(reader);
  if (!refusal.empty()) {
    return Error{ErrorCode::kUnsupported,
                 name + ": this PNG has " + refusal +
                     "; save it as 8-bit greyscale (terrain ids) or 24-bit "
                     "RGB (legend colours)"};
  }
  return Done{};
}

// Do so many bytes of pixels fit into a file of this length? Deflate makes at
// most 1,032 bytes of one (zlib's technical notes).
Status CheckLength(std::size_t size, std::string_view png,
                   const std::string& name) {
  constexpr std::size_t kMostOfAByte = 1032;
  if (size / kMostOfAByte <= png.size()) return Done{};
  return Error{ErrorCode::kInvalid,
               name + ": the PNG is truncated; copy the file again"};
}

std::vector<png_bytep> RowsOf(std::vector<std::uint8_t>& bytes,
                              std::size_t row_bytes) {
  std::vector<png_bytep> rows;
  for (std::size_t at = 0; at < bytes.size(); at += row_bytes) {
    rows.push_back(bytes.data() + at);
  }
  return rows;
}

}  // namespace

int BytesPerPixel(PixelOrder order) {
  return order == PixelOrder::kGrey ? 1 : 3;
}

bool IsPng(std::string_view bytes) {
  return bytes.starts_with(kSignature);
}

Result<Pixels> DecodePng(std::string_view png, int max_side,
                         const std::string& name) {
  Reader reader(png);
  if (!reader.ReadHeader()) return Damaged(name, reader);
  const Status size_taken = CheckSize(reader, max_side, name);
  if (!size_taken.ok()) return size_taken.error();
  const Status kind_taken = CheckKind(reader, name);
  if (!kind_taken.ok()) return kind_taken.error();
  Pixels pixels{static_cast<int>(reader.width()),
                static_cast<int>(reader.height()),
                reader.color_type() == PNG_COLOR_TYPE_GRAY ? PixelOrder::kGrey
                                                           : PixelOrder::kRgb,
                {}};
  const std::size_t row_bytes = RowBytes(pixels.width, pixels.order);
  const std::size_t size = row_bytes * static_cast<std::size_t>(pixels.height);
  const Status whole = CheckLength(size, png, name);
  if (!whole.ok()) return whole.error();
  pixels.bytes.resize(size);
  if (!reader.ReadPixels(RowsOf(pixels.bytes, row_bytes).data())) {
    return Damaged(name, reader);
  }
  return pixels;
}

Result<PngForm> ReadPngRows(std::string_view png, int max_side,
                            const std::string& name, const TakePngRow& take) {
  Reader reader(png);
  if (!reader.ReadHeader()) return Damaged(name, reader);
  const Status size_taken = CheckSize(reader, max_side, name);
  if (!size_taken.ok()) return size_taken.error();
  const auto height = static_cast<std::size_t>(reader.height());
  const Status whole = CheckLength(reader.row_bytes() * height, png, name);
  if (!whole.ok()) return whole.error();
  if (!reader.Expand()) return Damaged(name, reader);
  const PngForm form{static_cast<int>(reader.width()),
                     static_cast<int>(reader.height()), reader.channels(),
                     reader.bit_depth()};
  if (!reader.interlaced()) {
    std::vector<std::uint8_t> row(reader.row_bytes());
    if (!reader.ReadRows(form, row.data(), take)) return Damaged(name, reader);
    return form;
  }
  std::vector<std::uint8_t> bytes(reader.row_bytes() * height);
  std::vector<png_bytep> rows = RowsOf(bytes, reader.row_bytes());
  if (!reader.ReadPixels(rows.data())) {
    return Damaged(name, reader);
  }
  for (int y = 0; y < form.height; ++y) {
    take(form, y, rows[static_cast<std::size_t>(y)]);
  }
  return form;
}

std::string EncodePng(const PixelView& pixels, PngEffort effort) {
  TERRA_REQUIRE(pixels.width > 0 && pixels.height > 0);
  Writer writer;
  TERRA_REQUIRE(writer.Write(pixels, effort));
  return std::move(writer.bytes());
}

}  // namespace terra
