// Writes the models that the readers are compared on into a folder, and prints of each what our own reader
// finds: file, points, faces, colors, then the bounds in the world (m): x y z of the least and of the
// greatest corner.

#include "pipeline/model/vrml_reader.hpp"
#include "pipeline/model/vrml_writer.hpp"
#include "tests/pipeline/model/model_test_support.hpp"

#include <algorithm>
#include <clocale>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace bodyscan {
namespace {

Mesh extremes() {
  return {.points = {{-100000, 0.0001F, 99999.5F}, {100000, -0.0001F, -1}, {0, 100000, 12345.75F}, {1, 2, 3}},
          .colors = {{0, 1, 2}, {253, 254, 255}, {127, 128, 129}, {51, 102, 153}},
          .faces = {{0, 1, 2}, {3, 2, 1}}};
}

std::vector<std::pair<std::string, Mesh>> samples() {
  Mesh plain = relief(50, 40);
  plain.colors.clear();
  Mesh cloud = relief(60, 50);
  cloud.faces.clear();
  std::vector<std::pair<std::string, Mesh>> models;
  models.emplace_back("surface.wrl", relief(160, 120));
  models.emplace_back("plain.wrl", std::move(plain));
  models.emplace_back("cloud.wrl", std::move(cloud));
  models.emplace_back("extremes.wrl", extremes());
  return models;
}

void print(const std::string& name, const Mesh& mesh) {
  std::printf("%s %zu %zu %zu", name.c_str(), mesh.points.size(), mesh.faces.size(), mesh.colors.size());
  const auto bounds = [&](auto coordinate) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const Point3f& point : mesh.points) {
      low = std::min(low, coordinate(point) * 0.001);
      high = std::max(high, coordinate(point) * 0.001);
    }
    return std::pair(low, high);
  };
  const auto x = bounds([](const Point3f& point) { return static_cast<double>(point.x); });
  const auto y = bounds([](const Point3f& point) { return -static_cast<double>(point.y); });
  const auto z = bounds([](const Point3f& point) { return -static_cast<double>(point.z); });
  std::printf(" %.9g %.9g %.9g %.9g %.9g %.9g\n", x.first, y.first, z.first, x.second, y.second, z.second);
}

int run(const std::filesystem::path& folder) {
  const ModelInfo info = {.calibration = "lab \"A\" \\ 2026-01-31",
                          .software = "bodyscan",
                          .comment = "Unterarm, gr\xC3\xBC\xC3\x9F dich",
                          .closed = false};
  for (const auto& [name, mesh] : samples()) {
    const auto written = write_model(folder / name, mesh, info);
    const auto read = read_model(folder / name);
    if (!written || !read) {
      std::fprintf(stderr, "%s\n", (written ? read.error() : written.error()).message.c_str());
      return 1;
    }
    std::setlocale(LC_NUMERIC, "C");
    print(name, read->mesh);
    std::setlocale(LC_NUMERIC, "");
  }
  return 0;
}

}  // namespace
}  // namespace bodyscan

int main(int argc, char** argv) {
  if (argc != 2 || std::setlocale(LC_ALL, "") == nullptr) return 2;
  return bodyscan::run(argv[1]);
}
