#pragma once

#include "tools/simulator/serve/darkroom.hpp"
#include "tools/simulator/serve/ptp/codes.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace bodyscan::simulator {

// The camera's memory card, with its folders, and its RAM, which holds one picture.
class ObjectStore {
 public:
  static constexpr std::uint32_t storage = 0x00010001;
  // Nikon's handle of the picture in RAM.
  static constexpr std::uint32_t ram_handle = 0xFFFF0001;
  static constexpr std::size_t most_pictures = 200;  // on the card

  ObjectStore();

  [[nodiscard]] bool full() const { return pictures_on_card_ >= most_pictures; }
  // Both name the picture after the shot and answer its handle.
  std::uint32_t put_on_card(const Photo& photo, int shot);
  std::uint32_t put_in_ram(const Photo& photo, int shot);
  bool remove(std::uint32_t handle);

  struct Object {
    std::string name;
    ptp::ObjectFormat format{};
    std::uint32_t parent = 0;  // 0: the storage's root
    Photo photo;               // of a picture
    int shot = 0;
    std::string date;
  };
  [[nodiscard]] const Object* find(std::uint32_t handle) const;
  // Handles on the card; format 0: any; parent 0: any, 0xFFFFFFFF: the root.
  [[nodiscard]] std::vector<std::uint32_t> handles(std::uint32_t format, std::uint32_t parent) const;

 private:
  std::map<std::uint32_t, Object> objects_;
  std::size_t pictures_on_card_ = 0;
};

// The datasets ObjectInfo and StorageInfo (ISO 15740, 5.5.2 and 5.5.3).
ptp::Bytes object_info(const ObjectStore::Object& object);
ptp::Bytes storage_info(const ObjectStore& store);

}  // namespace bodyscan::simulator
