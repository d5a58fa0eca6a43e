#pragma once

#include "pipeline/base/error.hpp"

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace bodyscan {

// The part of OpenCV's FileStorage YAML that a calibration file uses: keys at the start of a line, each with
// a flow sequence of numbers or an !!opencv-matrix of doubles or floats; comments. Values of other kinds may
// stand there too and are never looked at. Strict where OpenCV guesses: every byte of a value asked for is
// accounted for, and a key occurs once.
class FileStorageText {
 public:
  static Expected<FileStorageText> parse(std::string_view text);

  // Finite numbers, `count` of them, row by row for a matrix. Messages start with the key.
  [[nodiscard]] Expected<std::vector<double>> sequence(const std::string& key, std::size_t count) const;
  // A finite number; nothing where there is none under that key.
  [[nodiscard]] std::optional<double> optional_number(const std::string& key) const;
  [[nodiscard]] Expected<std::vector<double>> matrix(const std::string& key, int rows, int columns) const;

 private:
  [[nodiscard]] Expected<std::string_view> value(const std::string& key) const;

  std::map<std::string, std::string, std::less<>> values_;  // without comments, lines joined
};

// The same format's text, for writing; numbers are the shortest that read back equal.
std::string file_storage_sequence(std::string_view key, std::span<const int> values);
std::string file_storage_number(std::string_view key, double value);
std::string file_storage_matrix(std::string_view key, int rows, int columns, std::span<const double> values);

constexpr std::string_view file_storage_header = "%YAML:1.0\n---\n";

}  // namespace bodyscan
