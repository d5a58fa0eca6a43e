#include "tools/evaluate/pfm.hpp"

#include <fstream>
#include <vector>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

class Pfm : public testing::Test {
 protected:
  void write(const std::string& header, const std::vector<float>& values) const {
    std::ofstream stream(file_, std::ios::binary);
    stream << header;
    stream.write(reinterpret_cast<const char*>(values.data()),
                 static_cast<std::streamsize>(values.size() * sizeof(float)));
  }
  void TearDown() override { std::filesystem::remove(file_); }

  std::filesystem::path file_ =
      std::filesystem::path(testing::TempDir()) /
      (std::string("pfm_") + testing::UnitTest::GetInstance()->current_test_info()->name() + ".pfm");
};

TEST_F(Pfm, TheBottomRowComesFirst) {
  write("Pf\n3 2\n-1.0\n", {4, 5, 6, 1, 2, 3});
  const Expected<FloatImage> image = read_pfm(file_);
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_EQ((*image)(0, 0), 1);
  EXPECT_EQ((*image)(2, 1), 6);
}

TEST_F(Pfm, ReadsVectors) {
  write("PF\n1 2\n-1.0\n", {4, 5, 6, 1, 2, 3});
  const Expected<Image<Point3f>> image = read_pfm_vectors(file_);
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_EQ((*image)(0, 0), (Point3f{1, 2, 3}));
}

TEST_F(Pfm, RefusesWhatIsNoMap) {
  struct Case {
    const char* header;
    std::size_t values;
    const char* reason;
  };
  for (const Case& one :
       {Case{"PF\n3 2\n-1.0\n", 6, "no Pf float map"}, Case{"Pf\n3 2\n1.0\n", 6, "byte order"},
        Case{"Pf\n3 -2\n-1.0\n", 6, "bad size"}, Case{"Pf\n99999 2\n-1.0\n", 6, "bad size"},
        Case{"Pf\n3 2\n-1.0\n", 5, "ends early"}, Case{"nonsense", 0, "no Pf float map"}}) {
    write(one.header, std::vector<float>(one.values, 1.F));
    const Expected<FloatImage> image = read_pfm(file_);
    ASSERT_FALSE(image) << one.header;
    EXPECT_NE(image.error().message.find(one.reason), std::string::npos) << image.error().message;
    EXPECT_NE(image.error().message.find(file_.string()), std::string::npos);
  }
  std::filesystem::remove(file_);
  EXPECT_NE(read_pfm(file_).error().message.find("cannot be read"), std::string::npos);
}

}  // namespace
}  // namespace bodyscan
