#include "hal/drm/drm_master.hpp"

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

TEST(DrmMaster, NamesACardThatIsNone) {
  EXPECT_EQ(DrmMaster::open("/dev/null").error().message, "/dev/null: has no display connectors");
  EXPECT_EQ(list_outputs("/dev/dri/none").error().message,
            "/dev/dri/none: cannot be opened: No such file or directory");
  EXPECT_EQ(list_outputs("/dev/null").error().kind, ErrorKind::device);
}

}  // namespace
}  // namespace bodyscan
