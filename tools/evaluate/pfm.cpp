#include "tools/evaluate/pfm.hpp"

#include <fstream>
#include <string>

namespace bodyscan {
namespace {

constexpr int max_side = 16384;

template <class Pixel>
Expected<Image<Pixel>> read(const std::filesystem::path& file, const std::string& kind) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return input_error(file.string() + ": cannot be read");
  stream.imbue(std::locale::classic());
  std::string found;
  Size size;
  double scale = 0;
  stream >> found >> size.width >> size.height >> scale;
  stream.get();
  if (!stream || found != kind) return input_error(file.string() + ": no " + kind + " float map");
  if (size.width < 1 || size.height < 1 || size.width > max_side || size.height > max_side || scale >= 0) {
    return input_error(file.string() + ": bad size or byte order");
  }
  Image<Pixel> image(size);
  const auto row_bytes = static_cast<std::streamsize>(sizeof(Pixel)) * size.width;
  for (int y = size.height - 1; y >= 0; --y) stream.read(reinterpret_cast<char*>(image.row(y)), row_bytes);
  if (!stream) return input_error(file.string() + ": ends early");
  return image;
}

}  // namespace

Expected<FloatImage> read_pfm(const std::filesystem::path& file) {
  return read<float>(file, "Pf");
}

Expected<Image<Point3f>> read_pfm_vectors(const std::filesystem::path& file) {
  return read<Point3f>(file, "PF");
}

}  // namespace bodyscan
