#include "pipeline/drawing/svg_picture.hpp"

#include "pipeline/base/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bodyscan {
namespace {

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      default:
        result += c >= 0 && c < ' ' ? '?' : c;  // XML knows no control characters
    }
  }
  return result;
}

std::string number(double value) {
  return short_text(value, 4);
}

// Attributes and tags are appended piece by piece: GCC 12 warns wrongly about "text" + std::string.
void append_attribute(std::string& text, std::string_view name, double value) {
  text.append(" ").append(name).append("=\"").append(number(value)).append("\"");
}

void append_attributes(std::string& text, std::string_view attributes) {
  if (!attributes.empty()) text.append(" ").append(attributes);
}

}  // namespace

SvgPicture::SvgPicture(double width, double height, std::string_view unit, std::string_view title) {
  text_ = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\"";
  for (const auto& [name, value] : {std::pair("width", width), std::pair("height", height)})
    text_.append(" ").append(name).append("=\"").append(number(value)).append(unit).append("\"");
  text_.append(" viewBox=\"0 0 ").append(number(width)).append(" ").append(number(height));
  text_.append("\" font-family=\"Helvetica, Arial, sans-serif\">\n<title>");
  text_.append(escaped(title)).append("</title>\n");
}

void SvgPicture::shape(std::string_view tag, std::initializer_list<Number> numbers,
                       std::string_view attributes) {
  for (const auto& [name, value] : numbers)
    if (!std::isfinite(value)) return;
  text_.append("<").append(tag);
  for (const auto& [name, value] : numbers) append_attribute(text_, name, value);
  append_attributes(text_, attributes);
  text_ += "/>\n";
}

void SvgPicture::rectangle(const Eigen::Vector2d& corner, const Eigen::Vector2d& size,
                           std::string_view attributes) {
  shape("rect", {{"x", corner.x()}, {"y", corner.y()}, {"width", size.x()}, {"height", size.y()}},
        attributes);
}

void SvgPicture::circle(const Eigen::Vector2d& center, double radius, std::string_view attributes) {
  shape("circle", {{"cx", center.x()}, {"cy", center.y()}, {"r", radius}}, attributes);
}

void SvgPicture::line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, std::string_view attributes) {
  shape("line", {{"x1", from.x()}, {"y1", from.y()}, {"x2", to.x()}, {"y2", to.y()}}, attributes);
}

void SvgPicture::polygon(std::span<const Eigen::Vector2d> points, std::string_view attributes) {
  if (!std::all_of(points.begin(), points.end(), [](const auto& point) { return point.allFinite(); })) return;
  text_ += "<polygon points=\"";
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i > 0) text_ += " ";
    text_.append(number(points[i].x())).append(",").append(number(points[i].y()));
  }
  text_ += "\"";
  append_attributes(text_, attributes);
  text_ += "/>\n";
}

void SvgPicture::text(const Eigen::Vector2d& start, double size, std::string_view content,
                      std::string_view attributes) {
  if (!start.allFinite()) return;
  text_ += "<text";
  append_attribute(text_, "x", start.x());
  append_attribute(text_, "y", start.y());
  append_attribute(text_, "font-size", size);
  append_attributes(text_, attributes);
  text_.append(">").append(escaped(content)).append("</text>\n");
}

void SvgPicture::begin_group(std::string_view attributes) {
  text_ += "<g";
  append_attributes(text_, attributes);
  text_ += ">\n";
}

void SvgPicture::end_group() {
  text_ += "</g>\n";
}

}  // namespace bodyscan
