#include "pipeline/drawing/page_writer.hpp"

#include "pipeline/base/number_text.hpp"
#include "pipeline/drawing/svg_picture.hpp"

#include <array>
#include <cstdio>
#include <string_view>
#include <vector>

namespace bodyscan {
namespace {

constexpr double points_per_mm = 72 / 25.4;
constexpr std::string_view title = "Calibration board";

std::string number(double value) {
  return short_text(value, 4);
}

std::string rectangle(const PageRectangle& shape, double page_height) {
  const double lower = page_height - shape.corner.y() - shape.size.y();
  return number(shape.corner.x()) + " " + number(lower) + " " + number(shape.size.x()) + " " +
         number(shape.size.y()) + " re\n";
}

std::string string_literal(std::string_view text) {
  std::string literal = "(";
  for (const char c : text) {
    if (c == '(' || c == ')' || c == '\\') literal += '\\';
    literal += c;
  }
  return literal + ")";
}

// In mm, y up.
std::string page_content(const BoardPage& page) {
  const double height = page.size_mm.y();
  const std::string scale = short_text(points_per_mm, 9);
  std::string content = scale + " 0 0 " + scale + " 0 0 cm\n0 g\n";
  for (const auto* shapes : {&page.squares, &page.ruler})
    for (const PageRectangle& shape : *shapes) content += rectangle(shape, height);
  content += "f\nBT\n/F1 " + number(page_text_mm) + " Tf\n";
  for (const PageText& text : page.texts)
    content += std::string(text.upwards ? "0 1 -1 0 " : "1 0 0 1 ") + number(text.start.x()) + " " +
               number(height - text.start.y()) + " Tm " + string_literal(text.text) + " Tj\n";
  return content + "ET\n";
}

// The objects become 1, 2, ... in their order.
std::string pdf_file(const std::vector<std::string>& objects, const std::string& trailer) {
  std::string file = "%PDF-1.4\n%\xe2\xe3\xcf\xd3\n";  // the second line says: not a text file
  std::string table = "0000000000 65535 f \n";
  for (std::size_t i = 0; i < objects.size(); ++i) {
    std::array<char, 32> entry{};
    std::snprintf(entry.data(), entry.size(), "%010zu 00000 n \n", file.size());
    table += entry.data();
    file += std::to_string(i + 1) + " 0 obj\n" + objects[i] + "\nendobj\n";
  }
  const std::string start = std::to_string(file.size());
  const std::string count = std::to_string(objects.size() + 1);
  return file + "xref\n0 " + count + "\n" + table + "trailer\n<< /Size " + count + " " + trailer +
         " >>\nstartxref\n" + start + "\n%%EOF\n";
}

}  // namespace

std::string to_svg(const BoardPage& page) {
  SvgPicture picture(page.size_mm.x(), page.size_mm.y(), "mm", title);
  picture.rectangle({0, 0}, page.size_mm, R"(class="paper" fill="#fff")");
  for (const PageRectangle& square : page.squares)
    picture.rectangle(square.corner, square.size, R"(class="square")");
  for (const PageRectangle& tick : page.ruler) picture.rectangle(tick.corner, tick.size, R"(class="ruler")");
  for (const PageText& text : page.texts) {
    const std::string turn =
        "transform=\"rotate(-90 " + number(text.start.x()) + " " + number(text.start.y()) + ")\"";
    picture.text(text.start, page_text_mm, text.text, text.upwards ? turn : std::string());
  }
  return picture.finish();
}

std::string to_pdf(const BoardPage& page) {
  const std::string content = page_content(page);
  const std::string box =
      short_text(page.size_mm.x() * points_per_mm, 6) + " " + short_text(page.size_mm.y() * points_per_mm, 6);
  return pdf_file({"<< /Type /Catalog /Pages 2 0 R /ViewerPreferences << /PrintScaling /None >> >>",
                   "<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
                   "<< /Type /Page /Parent 2 0 R /MediaBox [0 0 " + box +
                       "] /Resources << /Font << /F1 4 0 R >> >> /Contents 5 0 R >>",
                   "<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica /Encoding /WinAnsiEncoding >>",
                   "<< /Length " + std::to_string(content.size()) + " >>\nstream\n" + content + "endstream",
                   "<< /Title " + string_literal(title) + " >>"},
                  "/Root 1 0 R /Info 6 0 R");
}

}  // namespace bodyscan
