#pragma once

#include <string>
#include <utility>

#include <tl/expected.hpp>

namespace bodyscan {

// What kind of trouble an error is; the command line turns it into the exit status of the same meaning.
enum class ErrorKind {
  usage,    // the caller asked for something that does not exist
  input,    // an input file is missing, damaged or inconsistent
  output,   // a result cannot be written
  device,   // a device failed
  store,    // the store refused or failed
  quality,  // the result does not reach the quality asked for
};

// An error as a value. The message reads from the outside in: "capture.json: frames[3].bit: ...".
struct [[nodiscard]] Error {
  ErrorKind kind = ErrorKind::input;
  std::string message;

  // The same error, told from one level further out.
  [[nodiscard]] Error within(const std::string& place) const { return {kind, place + ": " + message}; }
};

template <class Value>
using Expected = tl::expected<Value, Error>;

[[nodiscard]] inline tl::unexpected<Error> input_error(std::string message) {
  return tl::unexpected(Error{ErrorKind::input, std::move(message)});
}

[[nodiscard]] inline tl::unexpected<Error> output_error(std::string message) {
  return tl::unexpected(Error{ErrorKind::output, std::move(message)});
}

[[nodiscard]] inline tl::unexpected<Error> device_error(std::string message) {
  return tl::unexpected(Error{ErrorKind::device, std::move(message)});
}

}  // namespace bodyscan
