#pragma once

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace bodyscan {

struct SvgElement {
  std::string tag;
  std::map<std::string, std::string> attributes;
  std::string text;  // behind the opening tag, as written

  [[nodiscard]] double number(const std::string& name) const {
    return std::strtod(attributes.at(name).c_str(), nullptr);
  }
};

// The elements of a plain XML text in their order; fails the test where tags do not match or attributes are
// not of the form name="value" or occur twice.
inline std::vector<SvgElement> read_svg(std::string_view text) {
  std::vector<SvgElement> elements;
  std::vector<std::string> open;
  std::size_t at = text.find("?>\n");
  EXPECT_EQ(text.substr(0, 5), "<?xml");
  while ((at = text.find('<', at)) != std::string_view::npos) {
    const std::size_t end = text.find('>', at);
    if (end == std::string_view::npos) {
      ADD_FAILURE() << "unfinished tag: " << text.substr(at, 80);
      break;
    }
    std::string_view tag = text.substr(at + 1, end - at - 1);
    at = end + 1;
    if (tag.starts_with('/')) {
      EXPECT_FALSE(open.empty());
      if (open.empty()) break;
      EXPECT_EQ(tag.substr(1), open.back());
      open.pop_back();
      continue;
    }
    const bool closed = tag.ends_with('/');
    if (closed) tag.remove_suffix(1);
    SvgElement element;
    element.tag = tag.substr(0, tag.find(' '));
    tag.remove_prefix(element.tag.size());
    while (!tag.empty()) {
      const std::size_t equals = tag.find("=\"");
      const std::size_t quote = tag.find('"', equals == std::string_view::npos ? equals : equals + 2);
      const bool whole = tag[0] == ' ' && quote != std::string_view::npos;
      EXPECT_TRUE(whole) << tag;
      if (!whole) break;
      const std::string name(tag.substr(1, equals - 1));
      EXPECT_TRUE(std::all_of(name.begin(), name.end(), [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || c == '-';
      })) << name;
      EXPECT_TRUE(element.attributes.emplace(name, tag.substr(equals + 2, quote - equals - 2)).second)
          << name;
      tag.remove_prefix(quote + 1);
    }
    element.text = text.substr(at, text.find('<', at) - at);
    if (!closed) open.push_back(element.tag);
    elements.push_back(std::move(element));
  }
  EXPECT_TRUE(open.empty());
  return elements;
}

inline std::vector<SvgElement> of_class(const std::vector<SvgElement>& elements, const std::string& name) {
  std::vector<SvgElement> found;
  for (const SvgElement& element : elements) {
    const auto attribute = element.attributes.find("class");
    if (attribute != element.attributes.end() && attribute->second == name) found.push_back(element);
  }
  return found;
}

// Whether a text element reads exactly so.
inline bool shows(const std::vector<SvgElement>& elements, const std::string& text) {
  return std::any_of(elements.begin(), elements.end(), [&](const SvgElement& element) {
    return element.tag == "text" && element.text == text;
  });
}

}  // namespace bodyscan
