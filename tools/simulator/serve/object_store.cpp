#include "tools/simulator/serve/object_store.hpp"

#include "tools/simulator/serve/ptp/date_time.hpp"

#include <array>
#include <cstdio>

namespace bodyscan::simulator {
namespace {

constexpr std::uint32_t dcim_handle = 0x20000000;
constexpr std::uint32_t folder_handle = 0x21900000;
constexpr std::uint32_t first_picture = 0x21910000;
constexpr std::uint32_t in_root = 0xFFFFFFFF;

std::string picture_name(int shot) {
  std::array<char, 16> name{};
  std::snprintf(name.data(), name.size(), "DSC_%04d.JPG", shot % 10'000);
  return name.data();
}

ObjectStore::Object picture(const Photo& photo, int shot, std::uint32_t parent) {
  return {picture_name(shot), ptp::ObjectFormat::exif_jpeg, parent, photo, shot, ptp::date_time_now()};
}

}  // namespace

ObjectStore::ObjectStore() {
  objects_[dcim_handle] = {"DCIM", ptp::ObjectFormat::association, 0, {}, 0, ptp::date_time_now()};
  objects_[folder_handle] = {"100D5000",          ptp::ObjectFormat::association, dcim_handle, {}, 0,
                             ptp::date_time_now()};
}

std::uint32_t ObjectStore::put_on_card(const Photo& photo, int shot) {
  const std::uint32_t handle = first_picture + static_cast<std::uint32_t>(shot);
  objects_[handle] = picture(photo, shot, folder_handle);
  ++pictures_on_card_;
  return handle;
}

std::uint32_t ObjectStore::put_in_ram(const Photo& photo, int shot) {
  objects_[ram_handle] = picture(photo, shot, 0);
  return ram_handle;
}

bool ObjectStore::remove(std::uint32_t handle) {
  const Object* object = find(handle);
  if (object == nullptr || object->format == ptp::ObjectFormat::association) return false;
  if (handle != ram_handle) --pictures_on_card_;
  objects_.erase(handle);
  return true;
}

const ObjectStore::Object* ObjectStore::find(std::uint32_t handle) const {
  const auto found = objects_.find(handle);
  return found == objects_.end() ? nullptr : &found->second;
}

std::vector<std::uint32_t> ObjectStore::handles(std::uint32_t format, std::uint32_t parent) const {
  std::vector<std::uint32_t> found;
  for (const auto& [handle, object] : objects_) {
    if (handle == ram_handle || (format != 0 && format != static_cast<std::uint32_t>(object.format)))
      continue;
    if (parent == 0 || object.parent == (parent == in_root ? 0 : parent)) found.push_back(handle);
  }
  return found;
}

ptp::Bytes object_info(const ObjectStore::Object& object) {
  const bool folder = object.format == ptp::ObjectFormat::association;
  const auto size_of = [](const SharedBytes& bytes) {
    return static_cast<std::uint32_t>(bytes ? bytes->size() : 0);
  };
  const auto number = [](int value) { return static_cast<std::uint32_t>(value); };
  constexpr std::uint32_t colour_depth = 24;
  constexpr std::uint16_t generic_folder = 1;
  ptp::DatasetWriter writer;
  writer.put(ObjectStore::storage).put(object.format);
  writer.put(std::uint16_t{0});  // unprotected
  writer.put(size_of(object.photo.jpeg));
  writer.put(static_cast<std::uint16_t>(folder ? 0 : static_cast<int>(ptp::ObjectFormat::jfif)));
  writer.put(size_of(object.photo.thumbnail));
  writer.put(number(object.photo.thumbnail_size.width)).put(number(object.photo.thumbnail_size.height));
  writer.put(number(object.photo.size.width)).put(number(object.photo.size.height));
  writer.put(folder ? 0 : colour_depth).put(object.parent);
  writer.put(folder ? generic_folder : std::uint16_t{0}).put(std::uint32_t{0}).put(number(object.shot));
  writer.text(object.name).text(object.date).text(object.date).text("");
  return writer.take();
}

ptp::Bytes storage_info(const ObjectStore& store) {
  constexpr std::uint16_t removable_ram = 4;
  constexpr std::uint16_t dcf = 3;
  constexpr std::uint16_t read_only_with_deletion = 2;
  constexpr std::uint64_t picture_bytes = 8 << 20;
  const std::size_t left =
      ObjectStore::most_pictures -
      (store.handles(static_cast<std::uint32_t>(ptp::ObjectFormat::exif_jpeg), 0).size());
  return ptp::DatasetWriter()
      .put(removable_ram)
      .put(dcf)
      .put(read_only_with_deletion)
      .put(ObjectStore::most_pictures * picture_bytes)
      .put(left * picture_bytes)
      .put(static_cast<std::uint32_t>(left))
      .text("")
      .text("SIMULATED")
      .take();
}

}  // namespace bodyscan::simulator
