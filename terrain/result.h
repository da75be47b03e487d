#pragma once

#include <string>
#include <utility>
#include <variant>

#include "terrain/require.h"

namespace terra {

/// Why the outside world (a file, a message, a reply) could not be used.
enum class ErrorCode {
  kInvalid,      ///< The content breaks a rule of its format.
  kNotFound,     ///< A file, key or map is not there.
  kUnsupported,  ///< Legal, but more than this program takes.
  kUnavailable,  ///< The system refused: disk, network, permission.
};

/// What went wrong, in a sentence that says where (file, line, pixel) and what
/// to do about it.
struct Error {
  ErrorCode code = ErrorCode::kInvalid;
  std::string message;
};

/// A value, or the error that stands in its place.
template <typename T>
class [[nodiscard]] Result {
 public:
  // Implicit on purpose: `return value;` and `return Error{...};` both read.
  Result(T value) : content_(std::move(value)) {}      // NOLINT
  Result(Error error) : content_(std::move(error)) {}  // NOLINT

  bool ok() const { return std::holds_alternative<T>(content_); }
  explicit operator bool() const { return ok(); }

  const T& value() const& {
    TERRA_REQUIRE(ok());
    return std::get<T>(content_);
  }
  T& value() & {
    TERRA_REQUIRE(ok());
    return std::get<T>(content_);
  }
  T&& value() && {
    TERRA_REQUIRE(ok());
    return std::get<T>(std::move(content_));
  }
  const T& operator*() const& { return value(); }
  T& operator*() & { return value(); }
  T&& operator*() && { return std::move(*this).value(); }
  const T* operator->() const { return &value(); }
  T* operator->() { return &value(); }

  const Error& error() const {
    TERRA_REQUIRE(!ok());
    return std::get<Error>(content_);
  }

 private:
  std::variant<T, Error> content_;
};

/// Nothing to return, but it can fail.
struct Done {};
using Status = Result<Done>;

}  // namespace terra
