#include "app/output_files.hpp"

#include "pipeline/image/codec.hpp"

#include <algorithm>
#include <system_error>

namespace bodyscan {
namespace {

// Without links and detours, as far as it exists.
std::filesystem::path resolved(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::weakly_canonical(std::filesystem::absolute(path, ignored), ignored);
}

}  // namespace

Expected<void> check_distinct(std::span<const std::filesystem::path> outputs,
                              std::span<const std::filesystem::path> inputs) {
  const auto same = [](const std::filesystem::path& a, const std::filesystem::path& b) {
    return resolved(a) == resolved(b);
  };
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (same(outputs[i], outputs[j]))
        return tl::unexpected(Error{ErrorKind::usage, outputs[i].string() + ": named for two results"});
    }
    for (const std::filesystem::path& input : inputs) {
      if (same(outputs[i], input))
        return tl::unexpected(
            Error{ErrorKind::usage, outputs[i].string() + ": is an input, not overwritten"});
    }
  }
  return {};
}

Expected<OptionalOutput> OptionalOutput::create(const OptionalPath& path) {
  OptionalOutput output;
  if (!path) return output;
  Expected<AtomicFile> file = AtomicFile::create(*path);
  if (!file) return tl::unexpected(file.error());
  output.file_ = std::move(*file);
  return output;
}

Expected<void> OptionalOutput::write(std::string_view bytes) {
  if (!file_) return {};
  return file_->write(bytes);
}

Expected<void> OptionalOutput::write_png(const ColorImage8& image) {
  const Expected<std::vector<std::byte>> file = encode_png(image);
  if (!file) return tl::unexpected(file.error());
  return write({reinterpret_cast<const char*>(file->data()), file->size()});
}

Expected<void> OptionalOutput::commit() {
  if (!file_) return {};
  return file_->commit(Durability::process);
}

Expected<OutputFolder> OutputFolder::create(const std::filesystem::path& path) {
  std::error_code code;
  std::vector<std::filesystem::path> missing;
  for (std::filesystem::path at = resolved(path); !std::filesystem::exists(at, code); at = at.parent_path())
    if (at.has_filename()) missing.push_back(at);
  code.clear();
  OutputFolder folder;
  std::ranges::reverse(missing);
  for (const std::filesystem::path& at : missing)
    if (!code && std::filesystem::create_directory(at, code)) folder.made_.push_back(at);
  if (code) return output_error(path.string() + ": " + code.message());
  if (!std::filesystem::is_directory(path, code)) return output_error(path.string() + ": is no folder");
  return folder;
}

OutputFolder::~OutputFolder() {
  std::error_code not_empty;
  for (; !made_.empty(); made_.pop_back()) std::filesystem::remove(made_.back(), not_empty);
}

}  // namespace bodyscan
