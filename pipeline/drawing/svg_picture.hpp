#pragma once

#include <initializer_list>
#include <span>
#include <string>
#include <string_view>

#include <Eigen/Core>

namespace bodyscan {

// A picture as SVG 1.1 text, shape upon shape; x to the right, y down, lengths in the picture's unit. A shape
// with a coordinate that is not finite is left out. `attributes` are SVG's, as written:
// `fill="none" stroke="#888"`.
class SvgPicture {
 public:
  // `unit` is that of the whole picture's size where it is printed: "mm", or "" for pixels.
  SvgPicture(double width, double height, std::string_view unit, std::string_view title);

  void rectangle(const Eigen::Vector2d& corner, const Eigen::Vector2d& size, std::string_view attributes);
  void circle(const Eigen::Vector2d& center, double radius, std::string_view attributes);
  void line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, std::string_view attributes);
  void polygon(std::span<const Eigen::Vector2d> points, std::string_view attributes);
  // `start` is the baseline's start, or its middle or end as attribute text-anchor says. Any text may stand
  // there; it is escaped.
  void text(const Eigen::Vector2d& start, double size, std::string_view content,
            std::string_view attributes = {});
  // What is drawn between the two belongs together: has the attributes of the group.
  void begin_group(std::string_view attributes);
  void end_group();

  // The whole file.
  [[nodiscard]] std::string finish() const { return text_ + "</svg>\n"; }

 private:
  struct Number {
    const char* name;
    double value;
  };
  void shape(std::string_view tag, std::initializer_list<Number> numbers, std::string_view attributes);

  std::string text_;
};

}  // namespace bodyscan
