#include "pipeline/calibration/calibration_file.hpp"

#include "pipeline/base/atomic_file.hpp"
#include "pipeline/base/read_file.hpp"
#include "pipeline/calibration/file_storage_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/LU>

namespace bodyscan {
namespace {

using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

constexpr int max_side_px = 1 << 15;
constexpr double rotation_tolerance = 1e-5;  // 0.01 mm at a metre
constexpr double min_baseline_mm = 1e-3;     // below, there is no depth to be had

bool all_finite(std::initializer_list<double> values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

Expected<void> check_lens(const Lens& lens, const std::string& device) {
  const auto side_exists = [](int side) { return side > 0 && side <= max_side_px; };
  if (!side_exists(lens.size.width) || !side_exists(lens.size.height))
    return input_error(device + "_size: sides must lie in 1 to " + std::to_string(max_side_px));
  if (!all_finite({lens.fx, lens.fy, lens.cx, lens.cy})) return input_error(device + "_matrix: not finite");
  if (lens.fx <= 0 || lens.fy <= 0) return input_error(device + "_matrix: focal lengths must be positive");
  const auto& k = lens.distortion;
  if (!all_finite({k[0], k[1], k[2], k[3], k[4]})) return input_error(device + "_distortion: not finite");
  return {};
}

Expected<void> check_transform(const RigidTransform& transform) {
  const Eigen::Matrix3d& rotation = transform.rotation;
  if (!rotation.allFinite()) return input_error("rotation: not finite");
  const Eigen::Matrix3d product = rotation.transpose() * rotation;
  const double error = (product - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(error <= rotation_tolerance) || rotation.determinant() <= 0)
    return input_error("rotation: not a rotation");
  if (!transform.translation.allFinite()) return input_error("translation: not finite");
  if (transform.translation.norm() < min_baseline_mm) return input_error("translation: zero baseline");
  return {};
}

Expected<int> whole_side(double value, const std::string& key) {
  if (value != std::floor(value) || value < 1 || value > max_side_px)
    return input_error(key + ": sides must be whole numbers in 1 to " + std::to_string(max_side_px));
  return static_cast<int>(value);
}

Expected<Lens> read_lens(const FileStorageText& text, const std::string& device) {
  Lens lens;
  const std::string size_key = device + "_size";
  const Expected<std::vector<double>> size = text.sequence(size_key, 2);
  if (!size) return tl::unexpected(size.error());
  const Expected<int> width = whole_side(size->at(0), size_key);
  if (!width) return tl::unexpected(width.error());
  const Expected<int> height = whole_side(size->at(1), size_key);
  if (!height) return tl::unexpected(height.error());
  lens.size = {*width, *height};

  const std::string matrix_key = device + "_matrix";
  const Expected<std::vector<double>> m = text.matrix(matrix_key, 3, 3);
  if (!m) return tl::unexpected(m.error());
  const auto at = [&](int row, int column) { return m->at(static_cast<std::size_t>(3 * row + column)); };
  if (at(0, 1) != 0 || at(1, 0) != 0 || at(2, 0) != 0 || at(2, 1) != 0 || at(2, 2) != 1)
    return input_error(matrix_key + ": not of the form fx 0 cx, 0 fy cy, 0 0 1");
  lens.fx = at(0, 0);
  lens.fy = at(1, 1);
  lens.cx = at(0, 2);
  lens.cy = at(1, 2);

  const Expected<std::vector<double>> distortion = text.matrix(device + "_distortion", 1, 5);
  if (!distortion) return tl::unexpected(distortion.error());
  std::copy_n(distortion->begin(), 5, lens.distortion.begin());
  return lens;
}

Expected<RigidTransform> read_transform(const FileStorageText& text) {
  const Expected<std::vector<double>> rotation = text.matrix("rotation", 3, 3);
  if (!rotation) return tl::unexpected(rotation.error());
  const Expected<std::vector<double>> translation = text.matrix("translation", 3, 1);
  if (!translation) return tl::unexpected(translation.error());
  return RigidTransform{RowMajor3(rotation->data()), Eigen::Vector3d(translation->data())};
}

Expected<Calibration> read_values(const FileStorageText& text) {
  const Expected<Lens> camera = read_lens(text, "camera");
  if (!camera) return tl::unexpected(camera.error());
  const Expected<Lens> projector = read_lens(text, "projector");
  if (!projector) return tl::unexpected(projector.error());
  const Expected<RigidTransform> transform = read_transform(text);
  if (!transform) return tl::unexpected(transform.error());
  const Calibration calibration{*camera, *projector, *transform};
  if (Expected<void> good = check_calibration(calibration); !good) return tl::unexpected(good.error());
  return calibration;
}

std::string lens_text(const Lens& lens, const std::string& device) {
  const std::array size{lens.size.width, lens.size.height};
  const std::array<double, 9> matrix{lens.fx, 0, lens.cx, 0, lens.fy, lens.cy, 0, 0, 1};
  return file_storage_sequence(device + "_size", size) +
         file_storage_matrix(device + "_matrix", 3, 3, matrix) +
         file_storage_matrix(device + "_distortion", 1, 5, lens.distortion);
}

std::string file_text(const Calibration& calibration) {
  const RowMajor3 rotation = calibration.projector_from_camera.rotation;
  const Eigen::Vector3d& translation = calibration.projector_from_camera.translation;
  return std::string(file_storage_header) + lens_text(calibration.camera, "camera") +
         lens_text(calibration.projector, "projector") +
         file_storage_matrix("rotation", 3, 3, {rotation.data(), 9}) +
         file_storage_matrix("translation", 3, 1, {translation.data(), 3});
}

std::string notes_text(const CalibrationNotes& notes) {
  std::string text;
  if (notes.calibrated_at) text += "calibrated_at: \"" + *notes.calibrated_at + "\"\n";
  for (const auto& [key, value] : {std::pair("camera_rms_px", notes.camera_rms_px),
                                   std::pair("projector_rms_px", notes.projector_rms_px),
                                   std::pair("stereo_rms_px", notes.stereo_rms_px)})
    if (value) text += file_storage_number(key, *value);
  return text;
}

}  // namespace

Expected<void> check_calibration(const Calibration& calibration) {
  if (Expected<void> good = check_lens(calibration.camera, "camera"); !good) return good;
  if (Expected<void> good = check_lens(calibration.projector, "projector"); !good) return good;
  return check_transform(calibration.projector_from_camera);
}

Expected<Calibration> parse_calibration(std::string_view text, const std::string& name) {
  if (text.size() > max_calibration_bytes)
    return input_error(name + ": over the limit of " + std::to_string(max_calibration_bytes) + " bytes");
  return FileStorageText::parse(text).and_then(read_values).map_error([&](const Error& error) {
    return error.within(name);
  });
}

Expected<CalibrationNotes> read_calibration_notes(const std::filesystem::path& path) {
  const Expected<std::vector<std::byte>> file = read_file(path, max_calibration_bytes);
  if (!file) return tl::unexpected(file.error());
  const Expected<FileStorageText> text =
      FileStorageText::parse(as_text(*file)).map_error([&](const Error& error) {
        return error.within(path.string());
      });
  if (!text) return tl::unexpected(text.error());
  return CalibrationNotes{std::nullopt, text->optional_number("camera_rms_px"),
                          text->optional_number("projector_rms_px"), text->optional_number("stereo_rms_px")};
}

Expected<Calibration> read_calibration(const std::filesystem::path& path) {
  const Expected<std::vector<std::byte>> file = read_file(path, max_calibration_bytes);
  if (!file) return tl::unexpected(file.error());
  return parse_calibration(as_text(*file), path.string());
}

Expected<std::string> calibration_text(const Calibration& calibration, const CalibrationNotes& notes) {
  if (Expected<void> good = check_calibration(calibration); !good) return output_error(good.error().message);
  return file_text(calibration) + notes_text(notes);
}

Expected<void> write_calibration(const Calibration& calibration, const std::filesystem::path& path) {
  const Expected<std::string> text = calibration_text(calibration).map_error([&](const Error& error) {
    return error.within(path.string());
  });
  if (!text) return tl::unexpected(text.error());
  Expected<AtomicFile> file = AtomicFile::create(path);
  if (!file) return tl::unexpected(file.error());
  if (Expected<void> written = file->write(*text); !written) return written;
  return file->commit(Durability::power_cut);
}

}  // namespace bodyscan
