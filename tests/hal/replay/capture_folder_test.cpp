#include "hal/replay/capture_folder.hpp"

#include "tests/hal/replay/capture_fixture.hpp"
#include "tests/pipeline/image/image_fixtures.hpp"

#include <set>

namespace bodyscan {
namespace {

class CaptureFolderTest : public CaptureFixture {
 protected:
  [[nodiscard]] std::string open_message() const {
    const auto capture = CaptureFolder::open(folder_);
    return capture ? "opened" : capture.error().message;
  }
};

TEST_F(CaptureFolderTest, OffersFramesInDecodeOrderWhateverTheFilesOrder) {
  std::reverse(manifest_.frames.begin(), manifest_.frames.end());
  ASSERT_TRUE(write_manifest(manifest_, folder_ / "capture.json"));
  const auto capture = CaptureFolder::open(folder_);
  ASSERT_TRUE(capture) << capture.error().message;
  EXPECT_EQ(capture->size(), frame_size);
  ASSERT_EQ(capture->frame_count(), 14);
  const PatternSequence sequence = make_sequence({16, 64}).value();
  for (int i = 0; i < capture->frame_count(); ++i) {
    const auto frame = capture->load(i);
    ASSERT_TRUE(frame) << frame.error().message;
    EXPECT_EQ(frame->pattern, sequence.patterns[static_cast<std::size_t>(i)]);
    EXPECT_EQ(std::get<GrayImage8>(frame->luma)(7, 3), value(i));
  }
}

TEST_F(CaptureFolderTest, LoadsJpegsAndSixteenBits) {
  write_image("frame_2.png", GrayImage16(frame_size, 54321));
  write_bytes(folder_ / "frame_3.png",
              make_gray_jpeg(GrayImage8(frame_size, 99)));  // the content decides, not the name
  const auto capture = CaptureFolder::open(folder_);
  ASSERT_TRUE(capture) << capture.error().message;
  EXPECT_EQ(std::get<GrayImage16>(capture->load(2)->luma)(0, 0), 54321);
  EXPECT_EQ(std::get<GrayImage8>(capture->load(3)->luma)(0, 0), 99);
}

TEST_F(CaptureFolderTest, WhiteAndBlackComeInColour) {
  write_image("frame_0.png", ColorImage8(frame_size, Rgb8{200, 150, 100}));
  write_image("frame_1.png", ColorImage8(frame_size, Rgb8{3, 2, 1}));
  const auto capture = CaptureFolder::open(folder_);
  ASSERT_TRUE(capture);
  const auto white = capture->load_white_color();
  ASSERT_TRUE(white) << white.error().message;
  EXPECT_EQ((*white)(7, 3), (Rgb8{200, 150, 100}));
  const auto black = capture->load_black_color();
  ASSERT_TRUE(black) << black.error().message;
  EXPECT_EQ((*black)(7, 3), (Rgb8{3, 2, 1}));
}

TEST_F(CaptureFolderTest, MemoryIsUsedAgain) {
  const auto capture = CaptureFolder::open(folder_);
  Frame frame;
  std::vector<std::byte> file(4096);
  const std::byte* file_memory = file.data();
  std::set<const void*> luma_memory;
  for (int i = 0; i < 4; ++i) {
    ASSERT_TRUE(capture->load_into(i, frame, file));
    luma_memory.insert(std::get<GrayImage8>(frame.luma).data());
  }
  EXPECT_EQ(file.data(), file_memory);
  EXPECT_EQ(luma_memory.size(), 1U);
}

TEST_F(CaptureFolderTest, OpenFindsTheSizeBehindLongMetadata) {
  std::vector<std::byte> jpeg = make_gray_jpeg(GrayImage8(frame_size, 99));
  std::vector<std::byte> comment(60000, std::byte{'x'});
  comment[0] = std::byte{0xff};
  comment[1] = std::byte{0xfe};  // COM, length 59998
  comment[2] = std::byte{59998 >> 8};
  comment[3] = std::byte{59998 & 255};
  for (int i = 0; i < 3; ++i) jpeg.insert(jpeg.begin() + 2, comment.begin(), comment.end());
  write_bytes(folder_ / "frame_3.png", jpeg);
  EXPECT_EQ(open_message(), "opened");
}

TEST_F(CaptureFolderTest, NamesWhatIsMissing) {
  std::filesystem::remove(folder_ / "frame_5.png");
  EXPECT_EQ(open_message(), path("frame_5.png") + ": No such file or directory");
  std::filesystem::remove(folder_ / "capture.json");
  EXPECT_EQ(open_message(), path("capture.json") + ": No such file or directory");
  EXPECT_EQ(CaptureFolder::open("/nonexistent").error().message,
            "/nonexistent/capture.json: No such file or directory");
}

TEST_F(CaptureFolderTest, NamesAFrameOfAnotherSize) {
  write_image("frame_5.png", GrayImage8({8, 5}, 0));
  EXPECT_EQ(open_message(),
            path("frame_5.png") + ": 8 x 5 pixels, while " + path("frame_0.png") + " has 8 x 4");
}

TEST_F(CaptureFolderTest, NamesABombAndANonImage) {
  write_bytes(folder_ / "frame_5.png",
              png_claiming(encode_png(GrayImage8(frame_size, 0)).value(), 16000, 16000));
  EXPECT_EQ(open_message(),
            path("frame_5.png") + ": 16000 x 16000 pixels: over the limit of 64000000 pixels");
  write_bytes(folder_ / "frame_4.png", {});
  EXPECT_EQ(open_message(), path("frame_4.png") + ": the file is empty");
  write_bytes(folder_ / "frame_3.png", std::as_bytes(std::span("hello")));
  EXPECT_EQ(open_message(), path("frame_3.png") + ": not a JPEG or PNG file");
}

TEST_F(CaptureFolderTest, NamesThePlaceInTheManifest) {
  manifest_.frames[3].pattern.bit = 12;
  ASSERT_TRUE(write_manifest(manifest_, folder_ / "capture.json"));
  EXPECT_EQ(open_message(), path("capture.json") + ": frames[3].bit: 12 does not exist for 64 rows");
}

TEST_F(CaptureFolderTest, LoadNamesATruncatedFile) {
  const auto capture = CaptureFolder::open(folder_);
  std::filesystem::resize_file(folder_ / "frame_0.png", 40);
  EXPECT_EQ(capture->load(0).error().message, path("frame_0.png") + ": damaged PNG: the file ends early");
  EXPECT_EQ(capture->load_white_color().error().message,
            path("frame_0.png") + ": damaged PNG: the file ends early");
}

TEST_F(CaptureFolderTest, LoadNoticesASizeThatChangedSinceOpen) {
  const auto capture = CaptureFolder::open(folder_);
  write_image("frame_0.png", GrayImage8({9, 4}, 0));
  EXPECT_FALSE(capture->load(0));
  EXPECT_FALSE(capture->load_white_color());
}

}  // namespace
}  // namespace bodyscan
