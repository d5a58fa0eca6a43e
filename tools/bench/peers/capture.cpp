#include "tools/bench/peers/capture.hpp"

#include <cstdio>
#include <fstream>
#include <memory>
#include <stdexcept>

#include <nlohmann/json.hpp>

namespace peer {

int Capture::bits(bool rows) const {
  int count = 0;
  while (gray.contains({rows, count, false})) ++count;
  return count;
}

Capture read_capture(const std::string& folder) {
  std::ifstream stream(folder + "/capture.json");
  const nlohmann::json manifest = nlohmann::json::parse(stream);
  Capture capture;
  capture.projector = {manifest.at("projector").at("width"), manifest.at("projector").at("height")};
  for (const nlohmann::json& frame : manifest.at("frames")) {
    const std::string file = folder + "/" + frame.at("file").get<std::string>();
    const std::string pattern = frame.at("pattern");
    if (pattern == "white") {
      capture.white = file;
    } else if (pattern == "black") {
      capture.black = file;
    } else {
      capture.gray[{frame.at("axis") == "row", frame.at("bit"), frame.at("inverted")}] = file;
    }
  }
  return capture;
}

Rig read_rig(const std::string& file) {
  const cv::FileStorage storage(file, cv::FileStorage::READ);
  if (!storage.isOpened()) throw std::runtime_error(file + ": cannot be read");
  const auto matrix = [&](const char* key) {
    cv::Mat value;
    storage[key] >> value;
    return value;
  };
  Rig rig;
  rig.camera = matrix("camera_matrix");
  rig.camera_distortion = matrix("camera_distortion");
  rig.projector = matrix("projector_matrix");
  rig.projector_distortion = matrix("projector_distortion");
  rig.rotation = matrix("rotation");
  const cv::Mat translation = matrix("translation");
  rig.translation = {translation.at<double>(0), translation.at<double>(1), translation.at<double>(2)};
  return rig;
}

void write_points(const std::string& file, const std::vector<cv::Point3f>& points,
                  const std::vector<cv::Vec3b>& colors) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> out(std::fopen(file.c_str(), "w"), std::fclose);
  if (!out) throw std::runtime_error(file + ": cannot be written");
  std::fprintf(out.get(),
               "#VRML V2.0 utf8\nTransform { rotation 1 0 0 3.14159265 scale 0.001 0.001 0.001 children [\n"
               "Shape { geometry PointSet { coord Coordinate { point [\n");
  for (const cv::Point3f& point : points) {
    std::fprintf(out.get(), "%f %f %f,\n", static_cast<double>(point.x), static_cast<double>(point.y),
                 static_cast<double>(point.z));
  }
  std::fprintf(out.get(), "] } color Color { color [\n");
  for (const cv::Vec3b& color : colors) {
    std::fprintf(out.get(), "%f %f %f,\n", color[2] / 255.0, color[1] / 255.0, color[0] / 255.0);
  }
  std::fprintf(out.get(), "] } } } ] }\n");
}

}  // namespace peer
