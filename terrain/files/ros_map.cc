// Source: the ROS map_server file format (wiki.ros.org/map_server, nav2). What
// the page leaves open is as their programs do it: negate, alpha, mode names.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include "terrain/builtin_legends.h"
#include "terrain/files/ascii_case.h"
#include "terrain/files/csv.h"
#include "terrain/files/image.h"
#include "terrain/files/map_formats.h"
#include "terrain/files/whole_file.h"

namespace terra {
namespace {

enum class Mode { kTrinary, kGreyIsId };

struct Settings {
  std::string image;
  MapPlacement placement;
  Mode mode = Mode::kTrinary;
  bool negate = false;
  double occupied_threshold = 0;
  double free_threshold = 0;
};

constexpr std::array<const char*, 7> kKeys = {
    "image",           "resolution",  "origin", "negate",
    "occupied_thresh", "free_thresh", "mode"};

std::string Quoted(const std::string& text) {
  return "'" + text + "'";
}

[[noreturn]] void Refuse(const YAML::Node& node, const std::string& what) {
  throw YAML::Exception(node.Mark(), what);
}

YAML::Node Get(const YAML::Node& yaml, const char* key) {
  YAML::Node value = yaml[key];
  if (!value) Refuse(yaml, "no " + Quoted(key));
  return value;
}

std::string GetText(const YAML::Node& yaml, const char* key) {
  const YAML::Node node = Get(yaml, key);
  if (!node.IsScalar() || node.Scalar().empty()) {
    Refuse(node, Quoted(key) + " takes one text");
  }
  return node.Scalar();
}

double ToNumber(const YAML::Node& node, const char* key, double low,
                double high) {
  double value = 0;
  if (!node.IsScalar() || !YAML::convert<double>::decode(node, value)) {
    Refuse(node, Quoted(key) + ": " +
                     (node.IsScalar() ? Quoted(node.Scalar()) : "this") +
                     " is not a number (write 0.05: a point, no unit)");
  }
  if (!(value >= low && value <= high)) {
    Refuse(node, Quoted(key) + " is out of its range, " + FormatNumber(low) +
                     " to " + FormatNumber(high));
  }
  return value;
}

// As Nav2 reads it: an integer, else one of YAML's words for yes and no.
bool GetNegate(const YAML::Node& yaml) {
  const YAML::Node node = Get(yaml, "negate");
  int number = 0;
  bool yes = false;
  if (node.IsScalar() && YAML::convert<int>::decode(node, number)) {
    return number != 0;
  }
  if (node.IsScalar() && YAML::convert<bool>::decode(node, yes)) return yes;
  Refuse(node, "'negate' takes 0 or 1, no or yes");
}

// Throws for a key of ours without a value, and for one that would be passed
// over: it comes twice, or is written in capitals.
void CheckKeys(const YAML::Node& yaml) {
  std::set<std::string> seen;
  for (const auto& entry : yaml) {
    if (!entry.first.IsScalar()) continue;
    const std::string& key = entry.first.Scalar();
    const std::string lower = LowerAscii(key);
    const bool ours =
        std::find(kKeys.begin(), kKeys.end(), lower) != kKeys.end();
    if (ours && key != lower) {
      Refuse(entry.first, Quoted(key) + " must be written " + Quoted(lower));
    }
    if (ours && entry.second.IsNull()) {
      Refuse(entry.first, Quoted(key) + " has no value");
    }
    if (ours && !seen.insert(key).second) {
      Refuse(entry.first, Quoted(key) + " comes twice");
    }
  }
}

Mode GetMode(const YAML::Node& yaml) {
  if (!yaml["mode"]) return Mode::kTrinary;
  const std::string mode = LowerAscii(GetText(yaml, "mode"));
  if (mode == "trinary") return Mode::kTrinary;
  if (mode != "scale" && mode != "raw") {
    Refuse(yaml["mode"],
           "mode " + Quoted(mode) + ": known are trinary, scale, raw");
  }
  return Mode::kGreyIsId;
}

MapPlacement GetPlacement(const YAML::Node& yaml) {
  constexpr double kFar = 1e9;  // metres; beyond the earth
  MapPlacement placement;
  placement.cell_size =
      ToNumber(Get(yaml, "resolution"), "resolution", 1e-6, kFar);
  const YAML::Node origin = Get(yaml, "origin");
  if (!origin.IsSequence() || origin.size() != 3) {
    Refuse(origin,
           "'origin' takes three numbers, [x, y, yaw], in metres and radians; "
           "the yaw of a map that is not turned is 0");
  }
  placement.origin_x = ToNumber(origin[0], "origin", -kFar, kFar);
  placement.origin_y = ToNumber(origin[1], "origin", -kFar, kFar);
  placement.origin_yaw = ToNumber(origin[2], "origin", -kFar, kFar);
  return placement;
}

Settings GetSettings(const YAML::Node& yaml) {
  CheckKeys(yaml);
  Settings settings;
  settings.image = GetText(yaml, "image");
  settings.placement = GetPlacement(yaml);
  settings.mode = GetMode(yaml);
  // What graded modes do not need must make sense all the same.
  const bool all = settings.mode == Mode::kTrinary;
  if (all || yaml["negate"]) settings.negate = GetNegate(yaml);
  const auto threshold = [&](const char* key) {
    return all || yaml[key] ? ToNumber(Get(yaml, key), key, 0, 1) : 0;
  };
  settings.occupied_threshold = threshold("occupied_thresh");
  settings.free_threshold = threshold("free_thresh");
  if (all && settings.free_threshold > settings.occupied_threshold) {
    Refuse(yaml["free_thresh"], "'free_thresh' is above 'occupied_thresh'");
  }
  return settings;
}

// Takes nothing of a document.
class PassOver : public YAML::EventHandler {
  using Mark = YAML::Mark;
  using Anchor = YAML::anchor_t;
  using Style = YAML::EmitterStyle::value;

  void OnDocumentStart(const Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const Mark&, Anchor) override {}
  void OnAlias(const Mark&, Anchor) override {}
  void OnScalar(const Mark&, const std::string&, Anchor,
                const std::string&) override {}
  void OnSequenceStart(const Mark&, const std::string&, Anchor,
                       Style) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const Mark&, const std::string&, Anchor, Style) override {}
  void OnMapEnd() override {}
};

// YAML::LoadAll would count them, but never ends on some texts (a lone comma is
// documents without end to it).
bool IsOneDocument(const std::string& text) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  PassOver pass_over;
  return parser.HandleNextDocument(pass_over) &&
         !parser.HandleNextDocument(pass_over);
}

Result<Settings> ParseSettings(std::string_view text, const std::string& name) {
  try {
    const std::string content(text);
    const YAML::Node yaml =
        IsOneDocument(content) ? YAML::Load(content) : YAML::Node();
    if (!yaml.IsMap()) {
      return Error{ErrorCode::kInvalid,
                   name + ": not a map_server yaml (one list of 'key: value')"};
    }
    return GetSettings(yaml);
  } catch (const YAML::Exception& error) {
    const int line = error.mark.line + 1;  // unknown: 0
    const std::string where = line > 0 ? ":" + std::to_string(line) : "";
    return Error{ErrorCode::kInvalid, name + where + ": " + error.msg};
  }
}

// A row of samples as a reader of pictures gives it.
class Samples {
 public:
  Samples(const PngForm& form, const std::uint8_t* row)
      : form_(form), row_(row) {}

  int At(int x, int channel) const {
    const auto at =
        static_cast<std::size_t>(x) * static_cast<std::size_t>(form_.channels) +
        static_cast<std::size_t>(channel);
    return form_.bits == 8 ? row_[at] : row_[2 * at] << 8 | row_[2 * at + 1];
  }

 private:
  const PngForm& form_;
  const std::uint8_t* row_;
};

// Makes ids of a picture, row by row.
class CellMaker {
 public:
  virtual ~CellMaker() = default;

  void Take(const PngForm& form, int y, const std::uint8_t* row) {
    if (y == 0) {
      ids_ = ByteRaster(form.height, form.width);
      Begin(form);
    }
    const Samples samples(form, row);
    for (int x = 0; x < form.width; ++x) {
      ids_(y, x) = IdOf(form, samples, Cell{x, y});
    }
  }

  /// What is wrong with the picture, or empty.
  const std::string& fault() const { return fault_; }
  ByteRaster& ids() { return ids_; }

 protected:
  virtual void Begin(const PngForm& form) = 0;
  virtual std::uint8_t IdOf(const PngForm& form, const Samples& samples,
                            Cell cell) = 0;
  void Fail(Cell cell, const std::string& what) {
    if (fault_.empty()) fault_ = "pixel " + ToString(cell) + " " + what;
  }

 private:
  ByteRaster ids_;
  std::string fault_;
};

// mode: trinary. The mean of all channels decides. Grey with alpha counts as
// the RGB of the same grey would, as with SDL and ImageMagick, which map_server
// and Nav2 read with: so three parts of grey, one of alpha.
class TrinaryCells : public CellMaker {
 public:
  TrinaryCells(const Settings& settings, const UnknownGround& unknown)
      : settings_(settings),
        unknown_is_given_(unknown.rule != UnknownGround::Rule::kFormat) {}

  /// How many cells are free though they have the grey that map savers give
  /// to unknown ground.
  std::int64_t doubtful() const { return doubtful_; }

 protected:
  void Begin(const PngForm& form) override {
    const int most = form.bits == 8 ? 255 : 65535;
    const int parts = form.channels == 1 ? 1 : form.has_alpha() ? 4 : 3;
    id_of_sum_.resize(static_cast<std::size_t>(parts * most) + 1);
    for (int sum = 0; sum <= parts * most; ++sum) {
      id_of_sum_[static_cast<std::size_t>(sum)] = Occupancy(sum, parts * most);
    }
    // map_saver writes no negated maps.
    if (settings_.negate) return;
    const int grey = kSavedAsUnknown * (most / 255);
    sum_of_unknown_ = form.has_alpha() ? 3 * grey + most : grey * form.channels;
    std::uint8_t& id = id_of_sum_[static_cast<std::size_t>(sum_of_unknown_)];
    if (unknown_is_given_) id = kOccupancyUnknown;
    if (id != kOccupancyFree) sum_of_unknown_ = -1;
  }

  std::uint8_t IdOf(const PngForm& form, const Samples& samples,
                    Cell cell) override {
    int sum = 0;
    for (int c = 0; c < form.channels; ++c) sum += samples.At(cell.x, c);
    if (form.channels == 2) sum += 2 * samples.At(cell.x, 0);
    if (sum == sum_of_unknown_) ++doubtful_;
    return id_of_sum_[static_cast<std::size_t>(sum)];
  }

 private:
  static constexpr int kSavedAsUnknown = 205;

  std::uint8_t Occupancy(int sum, int most) const {
    const double occupancy =
        static_cast<double>(settings_.negate ? sum : most - sum) /
        static_cast<double>(most);
    if (occupancy > settings_.occupied_threshold) return kOccupancyOccupied;
    if (occupancy < settings_.free_threshold) return kOccupancyFree;
    return kOccupancyUnknown;
  }

  const Settings& settings_;
  bool unknown_is_given_;
  std::vector<std::uint8_t> id_of_sum_;
  int sum_of_unknown_ = -1;  // -1 = not looked for.
  std::int64_t doubtful_ = 0;
};

// mode: scale and raw, with a legend of grey values.
class GreyCells : public CellMaker {
 protected:
  void Begin(const PngForm& /*form*/) override {}

  std::uint8_t IdOf(const PngForm& form, const Samples& samples,
                    Cell cell) override {
    const int grey = samples.At(cell.x, 0);
    const int colors = form.channels < 3 ? 1 : 3;
    for (int c = 1; c < colors; ++c) {
      if (samples.At(cell.x, c) != grey) {
        Fail(cell, "is not grey; the grey values are the ids of the legend");
      }
    }
    const int most = form.bits == 8 ? 255 : 65535;
    if (form.has_alpha() && samples.At(cell.x, colors) != most) {
      Fail(cell,
           "is transparent, which means unknown; give unknown ground a grey "
           "value of its own");
    }
    if (grey % (most / 255) != 0) {
      Fail(cell, "has a grey of 16 bits; save the picture with 8");
    }
    return static_cast<std::uint8_t>(grey / (most / 255));
  }
};

Status ReadPicture(const std::string& path, CellMaker& cells) {
  const Result<std::string> bytes = ReadWholeFile(path, kMaxImageBytes);
  if (!bytes.ok()) return bytes.error();
  if (IsPng(*bytes)) {
    const Result<PngForm> read =
        ReadPngRows(*bytes, TerrainMap::kMaxSide, path,
                    [&](const PngForm& form, int y, const std::uint8_t* row) {
                      cells.Take(form, y, row);
                    });
    if (!read.ok()) return read.error();
  } else {
    const Result<Pixels> image = DecodePgm(*bytes, path);
    if (!image.ok()) return image.error();
    const PngForm form{image->width, image->height};
    for (int y = 0; y < image->height; ++y) cells.Take(form, y, image->Row(y));
  }
  if (cells.fault().empty()) return Done{};
  return Error{ErrorCode::kInvalid, path + ": " + cells.fault()};
}

// Says what a free_thresh above 0.196 does to maps of the usual savers.
std::string DoubtNotice(const std::string& name, const Settings& settings,
                        std::int64_t doubtful, std::int64_t cells) {
  const auto percent = static_cast<std::int64_t>(std::ceil(
      100.0 * static_cast<double>(doubtful) / static_cast<double>(cells)));
  return name + ": " + std::to_string(doubtful) + " cells (" +
         std::to_string(percent) +
         " %) have the grey 205, with which map savers mark unknown ground. "
         "By this file's free_thresh of " +
         FormatNumber(settings.free_threshold) +
         " they are free, and routes may cross them. --unknown impassable "
         "closes them, --unknown free says that this is right";
}

}  // namespace

Result<RosMap> ParseRosMap(std::string_view text, const std::string& name,
                           bool own_legend, const UnknownGround& unknown) {
  const Result<Settings> settings = ParseSettings(text, name);
  if (!settings.ok()) return settings.error();
  const std::string image =
      (std::filesystem::path(name).parent_path() / settings->image).string();
  RosMap map;
  map.placement = settings->placement;
  if (settings->mode == Mode::kTrinary) {
    TrinaryCells cells(*settings, unknown);
    const Status read = ReadPicture(image, cells);
    if (!read.ok()) return read.error();
    if (cells.doubtful() > 0) {
      map.notices.push_back(
          DoubtNotice(name, *settings, cells.doubtful(), cells.ids().size()));
    }
    map.ids = std::move(cells.ids());
    return map;
  }
  if (!own_legend) {
    return Error{ErrorCode::kUnsupported,
                 name +
                     ": mode scale and raw have graded values, whose costs "
                     "only you know: give --legend FILE.csv (id = grey value)"};
  }
  if (unknown.rule != UnknownGround::Rule::kFormat) {
    return NoUnknownGround(name + ": in mode scale and raw");
  }
  if (settings->negate) {
    map.notices.push_back(name +
                          ": negate is not applied in mode scale and raw: the "
                          "legend's ids are the grey values as they stand in "
                          "the picture");
  }
  GreyCells cells;
  const Status read = ReadPicture(image, cells);
  if (!read.ok()) return read.error();
  map.ids = std::move(cells.ids());
  return map;
}

}  // namespace terra
