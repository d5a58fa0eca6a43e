#include "hal/gphoto2/picture_memory.hpp"

#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>

namespace bodyscan::gphoto2 {
namespace {

constexpr int unchangeable = F_SEAL_SEAL | F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE;

tl::unexpected<Error> memory_error() {
  return device_error("no memory for the picture: " + std::generic_category().message(errno));
}

}  // namespace

Expected<UniqueFd> seal_picture(std::span<const std::byte> bytes) {
  UniqueFd memory(::memfd_create("picture", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (!memory) return memory_error();
  for (std::span<const std::byte> rest = bytes; !rest.empty();) {
    const ssize_t written = ::write(memory.get(), rest.data(), rest.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return memory_error();
    rest = rest.subspan(static_cast<std::size_t>(written));
  }
  if (::fcntl(memory.get(), F_ADD_SEALS, unchangeable) != 0) return memory_error();
  return memory;
}

std::optional<std::vector<std::byte>> read_sealed_picture(int descriptor, std::size_t bytes) {
  const int seals = ::fcntl(descriptor, F_GET_SEALS);
  if (seals < 0 || (seals & unchangeable) != unchangeable) return {};
  struct stat status {};
  if (::fstat(descriptor, &status) != 0 || status.st_size < 0) return {};
  if (static_cast<std::size_t>(status.st_size) != bytes) return {};
  std::vector<std::byte> picture(bytes);
  std::size_t have = 0;
  while (have < bytes) {
    const ssize_t got = ::pread(descriptor, picture.data() + have, bytes - have, static_cast<off_t>(have));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return {};
    have += static_cast<std::size_t>(got);
  }
  return picture;
}

}  // namespace bodyscan::gphoto2
