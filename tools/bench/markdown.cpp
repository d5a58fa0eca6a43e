#include "tools/bench/markdown.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>

namespace bodyscan {
namespace {

std::string line_of(const std::vector<std::string>& cells) {
  std::string line = "|";
  for (const std::string& cell : cells) line += " " + cell + " |";
  return line + "\n";
}

}  // namespace

std::string markdown_table(const std::vector<std::vector<std::string>>& lines) {
  std::string text = line_of(lines.front());
  text += line_of(std::vector<std::string>(lines.front().size(), "---"));
  for (auto line = lines.begin() + 1; line != lines.end(); ++line) text += line_of(*line);
  return text;
}

std::string fixed(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

Expected<void> replace_section(const std::filesystem::path& file, const std::string& name,
                               const std::string& text) {
  std::string whole;
  if (std::ifstream stream(file); stream) whole.assign(std::istreambuf_iterator<char>(stream), {});
  const std::string first = "<!-- bench: " + name + " -->\n";
  const std::string last = "<!-- end: " + name + " -->\n";
  const std::size_t begin = whole.find(first);
  const std::size_t end = whole.find(last);
  const std::string section = first + text + last;
  if (begin != std::string::npos && end != std::string::npos && end > begin) {
    whole.replace(begin, end + last.size() - begin, section);
  } else {
    whole += (whole.empty() ? "" : "\n") + section;
  }
  std::ofstream stream(file, std::ios::trunc);
  stream << whole;
  stream.close();
  if (!stream) return output_error(file.string() + ": cannot be written");
  return {};
}

}  // namespace bodyscan
