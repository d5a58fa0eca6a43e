#include "pipeline/model/vrml_reader.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

namespace {

// What the reader promises of every model that it accepts.
bool keeps_promises(const bodyscan::VrmlModel& model, const bodyscan::VrmlLimits& limits) {
  const bodyscan::Mesh& mesh = model.mesh;
  for (const bodyscan::Face& face : mesh.faces) {
    for (const std::uint32_t index : face) {
      if (index >= mesh.points.size()) return false;
    }
  }
  return !mesh.points.empty() && mesh.points.size() <= limits.points && mesh.faces.size() <= limits.faces &&
         (mesh.colors.empty() || mesh.colors.size() == mesh.points.size());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  bodyscan::VrmlLimits limits;
  limits.points = 1000;
  limits.faces = 2000;
  limits.string_bytes = 500;
  const auto model =
      bodyscan::parse_model(std::string_view(reinterpret_cast<const char*>(data), size), limits);
  if (model && !keeps_promises(*model, limits)) std::abort();
  return 0;
}
