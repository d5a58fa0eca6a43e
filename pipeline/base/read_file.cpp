#include "pipeline/base/read_file.hpp"

#include <algorithm>
#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace bodyscan {
namespace {

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&&) = delete;
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  [[nodiscard]] int number() const { return number_; }

 private:
  int number_;
};

struct OpenFile {
  Descriptor descriptor;
  std::size_t size;
};

tl::unexpected<Error> failure(const std::filesystem::path& path, const std::string& reason) {
  return input_error(path.string() + ": " + reason);
}

tl::unexpected<Error> failure(const std::filesystem::path& path, int code) {
  return failure(path, std::generic_category().message(code));
}

Expected<OpenFile> open_file(const std::filesystem::path& path) {
  // Without O_NONBLOCK a named pipe would be waited for.
  Descriptor descriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (descriptor.number() < 0) return failure(path, errno);
  struct stat status {};
  if (::fstat(descriptor.number(), &status) != 0) return failure(path, errno);
  if (!S_ISREG(status.st_mode)) return failure(path, "not a regular file");
  return OpenFile{std::move(descriptor), static_cast<std::size_t>(status.st_size)};
}

Expected<void> fill(const std::filesystem::path& path, const OpenFile& file, std::vector<std::byte>& bytes) {
  std::size_t have = 0;
  while (have < bytes.size()) {
    const ssize_t got = ::read(file.descriptor.number(), bytes.data() + have, bytes.size() - have);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return failure(path, errno);
    if (got == 0) return failure(path, "the file became shorter while it was read");
    have += static_cast<std::size_t>(got);
  }
  return {};
}

}  // namespace

Expected<void> read_file_into(const std::filesystem::path& path, std::size_t max_bytes,
                              std::vector<std::byte>& bytes) {
  const Expected<OpenFile> file = open_file(path);
  if (!file) return tl::unexpected(file.error());
  if (file->size > max_bytes)
    return failure(path,
                   std::to_string(file->size) + " bytes, over the limit of " + std::to_string(max_bytes));
  bytes.resize(file->size);
  return fill(path, *file, bytes);
}

Expected<std::vector<std::byte>> read_file(const std::filesystem::path& path, std::size_t max_bytes) {
  std::vector<std::byte> bytes;
  if (Expected<void> read = read_file_into(path, max_bytes, bytes); !read)
    return tl::unexpected(read.error());
  return bytes;
}

Expected<std::vector<std::byte>> read_file_start(const std::filesystem::path& path, std::size_t count) {
  const Expected<OpenFile> file = open_file(path);
  if (!file) return tl::unexpected(file.error());
  std::vector<std::byte> bytes(std::min(count, file->size));
  if (Expected<void> read = fill(path, *file, bytes); !read) return tl::unexpected(read.error());
  return bytes;
}

}  // namespace bodyscan
