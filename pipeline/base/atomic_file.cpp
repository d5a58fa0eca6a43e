#include "pipeline/base/atomic_file.hpp"

#include <atomic>
#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

namespace bodyscan {
namespace {

tl::unexpected<Error> system_error(const std::filesystem::path& path, const char* action, int code) {
  return output_error(path.string() + ": " + action + ": " + std::generic_category().message(code));
}

std::filesystem::path temporary_name(const std::filesystem::path& path) {
  static std::atomic<unsigned> count = 0;
  std::string name = ".";
  name += path.filename().string();
  name += '.';
  name += std::to_string(::getpid());
  name += '-';
  name += std::to_string(count++);
  return path.parent_path() / (name + ".partial");
}

// 0 or errno.
int sync_folder(const std::filesystem::path& folder) {
  const int descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return errno;
  const int code = ::fsync(descriptor) == 0 ? 0 : errno;
  ::close(descriptor);
  return code;
}

}  // namespace

AtomicFile::AtomicFile(int descriptor, std::filesystem::path path, std::filesystem::path temporary)
    : descriptor_(descriptor), path_(std::move(path)), temporary_(std::move(temporary)) {}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      path_(std::move(other.path_)),
      temporary_(std::move(other.temporary_)) {}

AtomicFile& AtomicFile::operator=(AtomicFile&& other) noexcept {
  if (this != &other) {
    discard();
    descriptor_ = std::exchange(other.descriptor_, -1);
    path_ = std::move(other.path_);
    temporary_ = std::move(other.temporary_);
  }
  return *this;
}

AtomicFile::~AtomicFile() {
  discard();
}

void AtomicFile::discard() noexcept {
  if (descriptor_ < 0) return;
  ::close(std::exchange(descriptor_, -1));
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

tl::unexpected<Error> AtomicFile::failure(const char* action, int code) const {
  return system_error(path_, action, code);
}

Expected<AtomicFile> AtomicFile::create(const std::filesystem::path& path) {
  std::error_code ignored;
  std::filesystem::path target = std::filesystem::canonical(path, ignored);
  if (ignored) target = path;
  const auto status = std::filesystem::status(target, ignored);
  if (std::filesystem::is_directory(status)) return system_error(path, "cannot write", EISDIR);
  if (!target.has_filename()) return system_error(path, "cannot write", EINVAL);
  if (std::filesystem::is_other(status)) {
    const int descriptor = ::open(target.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor < 0) return system_error(path, "cannot open", errno);
    return AtomicFile(descriptor, path, {});
  }
  for (;;) {
    std::filesystem::path temporary = temporary_name(target);
    const int descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor >= 0) return AtomicFile(descriptor, std::move(target), std::move(temporary));
    if (errno != EEXIST) return system_error(path, "cannot create", errno);
  }
}

Expected<void> AtomicFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor_, bytes.data(), bytes.size());
    if (count >= 0) {
      bytes.remove_prefix(static_cast<std::size_t>(count));
    } else if (errno != EINTR) {
      return failure("cannot write", errno);
    }
  }
  return {};
}

Expected<void> AtomicFile::commit(Durability durability) {
  const bool to_disk = durability == Durability::power_cut && !temporary_.empty();
  if (to_disk && ::fsync(descriptor_) != 0) return failure("cannot write", errno);
  if (::close(std::exchange(descriptor_, -1)) != 0) {
    const int code = errno;
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
    return failure("cannot write", code);
  }
  if (temporary_.empty()) return {};
  if (::rename(temporary_.c_str(), path_.c_str()) != 0) {
    const int code = errno;
    ::unlink(temporary_.c_str());
    return failure("cannot rename", code);
  }
  if (to_disk) {
    if (const int code = sync_folder(path_.parent_path())) return failure("cannot write", code);
  }
  return {};
}

}  // namespace bodyscan
