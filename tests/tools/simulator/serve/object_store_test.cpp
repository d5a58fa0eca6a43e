#include "tools/simulator/serve/object_store.hpp"

#include <gtest/gtest.h>

namespace bodyscan::simulator {
namespace {

Photo photo(std::size_t bytes) {
  return {std::make_shared<const ptp::Bytes>(bytes),
          {429, 285},
          std::make_shared<const ptp::Bytes>(9),
          {160, 106}};
}

TEST(ObjectStore, ThePictureInRamIsNoneOfTheCards) {
  ObjectStore store;
  EXPECT_EQ(store.put_in_ram(photo(100), 1), ObjectStore::ram_handle);
  EXPECT_EQ(store.handles(0, 0).size(), 2U);  // the folders
  EXPECT_TRUE(store.remove(ObjectStore::ram_handle));
  EXPECT_FALSE(store.remove(ObjectStore::ram_handle));
  EXPECT_EQ(store.find(ObjectStore::ram_handle), nullptr);
}

TEST(ObjectStore, PicturesLieInTheFolderOfTheCard) {
  ObjectStore store;
  const std::uint32_t handle = store.put_on_card(photo(100), 12);
  const std::vector<std::uint32_t> root = store.handles(0, 0xFFFFFFFF);
  ASSERT_EQ(root.size(), 1U);
  EXPECT_EQ(store.find(root[0])->name, "DCIM");
  const std::vector<std::uint32_t> folders = store.handles(0, root[0]);
  ASSERT_EQ(folders.size(), 1U);
  EXPECT_EQ(store.find(folders[0])->name, "100D5000");
  EXPECT_EQ(store.handles(0, folders[0]), std::vector{handle});
  EXPECT_EQ(store.find(handle)->name, "DSC_0012.JPG");
  EXPECT_FALSE(store.remove(folders[0]));
  EXPECT_TRUE(store.remove(handle));
  EXPECT_TRUE(store.handles(0, folders[0]).empty());
}

TEST(ObjectStore, ACardGetsFull) {
  ObjectStore store;
  std::uint32_t last = 0;
  for (int shot = 1; shot <= static_cast<int>(ObjectStore::most_pictures); ++shot) {
    EXPECT_FALSE(store.full());
    last = store.put_on_card(photo(1), shot);
  }
  EXPECT_TRUE(store.full());
  store.remove(last);
  EXPECT_FALSE(store.full());
}

TEST(ObjectStore, ObjectInfoTellsTheSizeOfTheFile) {
  ObjectStore store;
  const ptp::Bytes info = object_info(*store.find(store.put_in_ram(photo(12345), 3)));
  ptp::DatasetReader reader(info);
  EXPECT_EQ(reader.get<std::uint32_t>(), ObjectStore::storage);
  EXPECT_EQ(reader.get<ptp::ObjectFormat>(), ptp::ObjectFormat::exif_jpeg);
  reader.get<std::uint16_t>();
  EXPECT_EQ(reader.get<std::uint32_t>(), 12345U);
  reader.get<std::uint16_t>();
  EXPECT_EQ(reader.get<std::uint32_t>(), 9U);
  EXPECT_EQ(reader.get<std::uint32_t>(), 160U);
  EXPECT_EQ(reader.get<std::uint32_t>(), 106U);
  EXPECT_EQ(reader.get<std::uint32_t>(), 429U);
  EXPECT_EQ(reader.get<std::uint32_t>(), 285U);
}

}  // namespace
}  // namespace bodyscan::simulator
