#include "app/model_files.hpp"

#include <utility>

namespace bodyscan {

std::vector<std::filesystem::path> ModelOptions::paths() const {
  std::vector<std::filesystem::path> all{path};
  for (const OptionalPath* other : {&report, &preview, &depth, &rows})
    if (*other) all.push_back(**other);
  return all;
}

Expected<ModelFiles> ModelFiles::open(const ModelOptions& options, const ModelInfo& info) {
  Expected<VrmlWriter> model = VrmlWriter::create(options.path, VrmlGeometry::face_set, info);
  if (!model) return tl::unexpected(model.error());
  ModelFiles files{std::move(*model), {}, {}, {}, {}};
  for (const auto& [output, path] :
       {std::pair(&files.report, &options.report), std::pair(&files.preview, &options.preview),
        std::pair(&files.depth, &options.depth), std::pair(&files.rows, &options.rows)}) {
    Expected<OptionalOutput> file = OptionalOutput::create(*path);
    if (!file) return tl::unexpected(file.error());
    *output = std::move(*file);
  }
  return files;
}

Expected<void> ModelFiles::commit() {
  return model.finish()
      .and_then([&] { return report.commit(); })
      .and_then([&] { return preview.commit(); })
      .and_then([&] { return depth.commit(); })
      .and_then([&] { return rows.commit(); });
}

}  // namespace bodyscan
