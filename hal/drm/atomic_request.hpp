#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

struct _drmModeAtomicReq;

namespace bodyscan {

// A connector, CRTC or plane: its properties by name, as they were when it was read.
class KmsObject {
 public:
  static KmsObject connector(int fd, std::uint32_t id);
  static KmsObject crtc(int fd, std::uint32_t id);
  static KmsObject plane(int fd, std::uint32_t id);

  [[nodiscard]] std::uint32_t id() const { return id_; }
  [[nodiscard]] std::optional<std::uint32_t> property_id(const std::string& name) const;
  [[nodiscard]] std::optional<std::uint64_t> value(const std::string& name) const;

 private:
  struct Property {
    std::uint32_t id = 0;
    std::uint64_t value = 0;
  };

  KmsObject(int fd, std::uint32_t id, std::uint32_t type);

  std::uint32_t id_;
  std::map<std::string, Property> properties_;
};

// Property changes that the kernel makes together or not at all.
class AtomicRequest {
 public:
  AtomicRequest();
  AtomicRequest(const AtomicRequest&) = delete;
  AtomicRequest& operator=(const AtomicRequest&) = delete;
  ~AtomicRequest();

  // A property that the object does not have makes `commit` fail.
  void set(const KmsObject& object, const std::string& property, std::uint64_t value);
  void set_if_there(const KmsObject& object, const std::string& property, std::uint64_t value);

  // 0, or errno's value. `event_tag` comes back with the page-flip event, where `flags` ask for one.
  [[nodiscard]] int commit(int fd, std::uint32_t flags, void* event_tag = nullptr);

 private:
  _drmModeAtomicReq* request_;
  bool complete_ = true;
};

}  // namespace bodyscan
