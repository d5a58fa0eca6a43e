#include "pipeline/drawing/page_writer.hpp"

#include "tests/pipeline/drawing/svg_reader.hpp"

#include <sstream>

namespace bodyscan {
namespace {

using Eigen::Vector2d;

// Squares of a third of a millimetre's multiple, on A4 with the ruler at the right.
BoardPage sample_page() {
  return printable_board({.columns = 9, .rows = 7, .square_mm = 24.3333}, {210, 297}).value();
}

void expect_near(const Vector2d& found, const Vector2d& wanted) {
  EXPECT_LT((found - wanted).cwiseAbs().maxCoeff(), 6e-5);  // four decimals
}

TEST(PageAsSvg, HasMillimetresAndEveryRectangleAtItsPlace) {
  const BoardPage page = sample_page();
  const auto elements = read_svg(to_svg(page));
  EXPECT_EQ(elements.at(0).attributes.at("width"), "297mm");
  EXPECT_EQ(elements.at(0).attributes.at("height"), "210mm");
  EXPECT_EQ(elements.at(0).attributes.at("viewBox"), "0 0 297 210");
  for (const auto& [name, shapes] : {std::pair("square", &page.squares), std::pair("ruler", &page.ruler)}) {
    const auto found = of_class(elements, name);
    ASSERT_EQ(found.size(), shapes->size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(found[i].tag, "rect");
      EXPECT_EQ(found[i].attributes.count("fill"), 0U);  // black
      expect_near({found[i].number("x"), found[i].number("y")}, (*shapes)[i].corner);
      expect_near({found[i].number("width"), found[i].number("height")}, (*shapes)[i].size);
    }
  }
  EXPECT_TRUE(shows(elements, "measure this ruler: 100 mm"));
  EXPECT_EQ(elements.back().attributes.count("transform"), 1U);  // the ruler's text reads upwards
}

// The number that stands behind `key`.
std::size_t number_behind(const std::string& text, const std::string& key) {
  const std::size_t at = text.rfind(key);
  EXPECT_NE(at, std::string::npos) << key;
  return std::strtoul(text.c_str() + at + key.size(), nullptr, 10);
}

TEST(PageAsPdf, CrossReferencesPointAtTheObjects) {
  const std::string file = to_pdf(sample_page());
  EXPECT_EQ(file.substr(0, 9), "%PDF-1.4\n");
  EXPECT_TRUE(file.ends_with("\n%%EOF\n"));
  const std::size_t table = number_behind(file, "startxref\n");
  ASSERT_EQ(file.substr(table, 7), "xref\n0 ");
  const std::size_t count = number_behind(file, "xref\n0 ");
  EXPECT_EQ(count, number_behind(file, "/Size "));
  const std::size_t first = file.find('\n', table + 7) + 1;
  EXPECT_EQ(file.substr(first, 20), "0000000000 65535 f \n");
  for (std::size_t i = 1; i < count; ++i) {
    const std::string entry = file.substr(first + 20 * i, 20);  // exactly twenty bytes each
    EXPECT_EQ(entry.substr(10), " 00000 n \n");
    const std::string head = std::to_string(i) + " 0 obj\n";
    EXPECT_EQ(file.substr(std::stoul(entry), head.size()), head);
  }
  EXPECT_EQ(file.substr(first + 20 * count, 8), "trailer\n");
}

TEST(PageAsPdf, StreamHasTheLengthThatItSays) {
  const std::string file = to_pdf(sample_page());
  const std::size_t stream = file.find(">>\nstream\n") + 10;
  EXPECT_EQ(file.find("endstream") - stream, number_behind(file, "/Length "));
}

TEST(PageAsPdf, HasEveryRectangleAtItsPlaceInPoints) {
  const BoardPage page = sample_page();
  const std::string file = to_pdf(page);
  const std::size_t box_at = file.find("/MediaBox [0 0 ") + 15;
  std::istringstream box(file.substr(box_at, 40));
  Vector2d points;
  box >> points.x() >> points.y();
  EXPECT_LT((points - page.size_mm * 72 / 25.4).norm(), 1e-5);

  std::istringstream content(file.substr(file.find("stream\n") + 7));
  double scale = 0;
  content >> scale;
  EXPECT_NEAR(scale, 72 / 25.4, 1e-8);
  std::vector<PageRectangle> shapes = page.squares;
  shapes.insert(shapes.end(), page.ruler.begin(), page.ruler.end());
  std::size_t found = 0;
  for (std::string line; std::getline(content, line) && line != "f";) {
    if (!line.ends_with(" re")) continue;
    std::istringstream numbers(line);
    Vector2d corner;
    Vector2d size;
    numbers >> corner.x() >> corner.y() >> size.x() >> size.y();
    ASSERT_LT(found, shapes.size());
    expect_near(size, shapes[found].size);
    expect_near({corner.x(), page.size_mm.y() - corner.y() - size.y()}, shapes[found].corner);
    ++found;
  }
  EXPECT_EQ(found, shapes.size());
}

TEST(PageAsPdf, TextsAreEscapedAndTurned) {
  BoardPage page = sample_page();
  page.texts = {{{10, 20}, false, "a (b\\"}, {{30, 40}, true, "up"}};
  const std::string file = to_pdf(page);
  EXPECT_NE(file.find("1 0 0 1 10 190 Tm (a \\(b\\\\) Tj"), std::string::npos);
  EXPECT_NE(file.find("0 1 -1 0 30 170 Tm (up) Tj"), std::string::npos);
}

}  // namespace
}  // namespace bodyscan
