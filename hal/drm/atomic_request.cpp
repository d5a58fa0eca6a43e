#include "hal/drm/atomic_request.hpp"

#include "hal/drm/kms_answers.hpp"

#include <cerrno>

namespace bodyscan {

KmsObject KmsObject::connector(int fd, std::uint32_t id) {
  return {fd, id, DRM_MODE_OBJECT_CONNECTOR};
}

KmsObject KmsObject::crtc(int fd, std::uint32_t id) {
  return {fd, id, DRM_MODE_OBJECT_CRTC};
}

KmsObject KmsObject::plane(int fd, std::uint32_t id) {
  return {fd, id, DRM_MODE_OBJECT_PLANE};
}

KmsObject::KmsObject(int fd, std::uint32_t id, std::uint32_t type) : id_(id) {
  const KmsObjectProperties all(drmModeObjectGetProperties(fd, id, type));
  if (!all) return;
  for (std::uint32_t i = 0; i < all->count_props; ++i)
    if (const KmsProperty property{drmModeGetProperty(fd, all->props[i])})
      properties_[property->name] = {property->prop_id, all->prop_values[i]};
}

std::optional<std::uint32_t> KmsObject::property_id(const std::string& name) const {
  const auto found = properties_.find(name);
  return found == properties_.end() ? std::nullopt : std::optional(found->second.id);
}

std::optional<std::uint64_t> KmsObject::value(const std::string& name) const {
  const auto found = properties_.find(name);
  return found == properties_.end() ? std::nullopt : std::optional(found->second.value);
}

AtomicRequest::AtomicRequest() : request_(drmModeAtomicAlloc()) {}

AtomicRequest::~AtomicRequest() {
  drmModeAtomicFree(request_);
}

void AtomicRequest::set(const KmsObject& object, const std::string& property, std::uint64_t value) {
  const std::optional<std::uint32_t> id = object.property_id(property);
  complete_ = id && drmModeAtomicAddProperty(request_, object.id(), *id, value) >= 0 && complete_;
}

void AtomicRequest::set_if_there(const KmsObject& object, const std::string& property, std::uint64_t value) {
  if (object.property_id(property)) set(object, property, value);
}

int AtomicRequest::commit(int fd, std::uint32_t flags, void* event_tag) {
  if (!complete_) return ENOENT;
  return drmModeAtomicCommit(fd, request_, flags, event_tag) == 0 ? 0 : errno;
}

}  // namespace bodyscan
