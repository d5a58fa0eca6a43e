#include "hal/replay/capture_manifest.hpp"

#include "pipeline/base/read_file.hpp"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

// Three rows: two bits; rows with inverses, in no order.
constexpr std::string_view good = R"({
  "format": "bodyscan-capture", "version": 1,
  "projector": {"width": 1024, "height": 3},
  "camera": "Nikon D5000", "exposure_us": 16666.7, "iso": 200, "aperture": 5.6,
  "captured_at": "2026-03-01T10:00:00Z", "response": 2.2, "patient_position": [1, {"x": null}],
  "frames": [
    {"file": "f.png", "pattern": "gray", "axis": "row", "bit": 0, "inverted": true},
    {"file": "e.png", "pattern": "gray", "axis": "row", "bit": 0, "inverted": false, "timestamp_us": -5},
    {"file": "d.png", "pattern": "gray", "axis": "row", "bit": 1, "inverted": true, "note": "x"},
    {"file": "b.png", "pattern": "black"},
    {"file": "c.png", "pattern": "gray", "axis": "row", "bit": 1, "inverted": false},
    {"file": "a.png", "pattern": "white"}
  ]
})";

std::string replaced(std::string_view from, std::string_view to) {
  std::string text(good);
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::string message(const std::string& text) {
  const auto manifest = parse_manifest(text, "capture.json");
  return manifest ? "accepted" : manifest.error().message;
}

std::string files(const CaptureManifest& manifest) {
  std::string names;
  for (const ManifestFrame& frame : manifest.frames) names += frame.file + ' ';
  return names;
}

TEST(ParseManifest, ReadsEveryKeyAndOrdersTheFrames) {
  const auto manifest = parse_manifest(good, "capture.json");
  ASSERT_TRUE(manifest) << manifest.error().message;
  EXPECT_EQ(manifest->projector, (Size{1024, 3}));
  EXPECT_EQ(manifest->camera, "Nikon D5000");
  EXPECT_EQ(manifest->exposure_us, 16666.7);
  EXPECT_EQ(manifest->iso, 200);
  EXPECT_EQ(manifest->aperture, 5.6);
  EXPECT_EQ(manifest->captured_at, "2026-03-01T10:00:00Z");
  EXPECT_EQ(manifest->response, (ToneResponse{ToneResponse::Kind::gamma, 2.2}));
  EXPECT_EQ(files(*manifest), "a.png b.png c.png d.png e.png f.png ");
  EXPECT_EQ(manifest->frames[3].pattern, (Pattern{PatternKind::gray, Axis::row, 1, true}));
  EXPECT_EQ(manifest->frames[3].timestamp_us, std::nullopt);
  EXPECT_EQ(manifest->frames[4].timestamp_us, -5);
}

TEST(ParseManifest, RowsComeBeforeColumnsAndEachAxisMayLackInverses) {
  const auto manifest = parse_manifest(R"({"format": "bodyscan-capture", "version": 1,
    "projector": {"width": 3, "height": 2}, "frames": [
    {"file": "3", "pattern": "gray", "axis": "column", "bit": 1},
    {"file": "5", "pattern": "gray", "axis": "row", "bit": 0, "inverted": true},
    {"file": "2", "pattern": "gray", "axis": "column", "bit": 0, "inverted": false},
    {"file": "1", "pattern": "black"}, {"file": "0", "pattern": "white"},
    {"file": "4", "pattern": "gray", "axis": "row", "bit": 0, "inverted": false}]})",
                                       "capture.json");
  ASSERT_TRUE(manifest) << manifest.error().message;
  EXPECT_EQ(files(*manifest), "0 1 4 5 3 2 ");
  EXPECT_FALSE(manifest->response.has_value());
}

TEST(ParseManifest, KnowsTheResponsesByName) {
  const auto response = [](std::string_view text) {
    return parse_manifest(replaced("2.2", text), "").value().response;
  };
  EXPECT_EQ(response("\"srgb\"").value().kind, ToneResponse::Kind::srgb);
  EXPECT_EQ(response("\"linear\"").value().kind, ToneResponse::Kind::linear);
}

struct Damage {
  std::string_view from;
  std::string_view to;
  std::string_view message;  // behind "capture.json: "
};

constexpr Damage damages[] = {
    // the head
    {"bodyscan-capture", "bodyscan-session", "format: \"bodyscan-session\" is not bodyscan-capture"},
    {"\"format\"", "\"kind\"", "format: missing"},
    {"\"version\": 1", "\"version\": 2", "version: 2 is not 1"},
    {"\"version\": 1", "\"version\": \"1\"", "version: not an integer"},
    {"\"version\": 1", "\"version\": 1, \"version\": 1", "the key \"version\" occurs twice in one object"},
    {"\"projector\"", "\"beamer\"", "projector: missing"},
    {"{\"width\": 1024, \"height\": 3}", "[1024, 3]", "projector: not an object"},
    {"\"height\": 3", "\"h\": 3", "projector.height: missing"},
    {"\"height\": 3", "\"height\": 3.0", "projector.height: not an integer"},
    {"\"height\": 3", "\"height\": 1", "projector.height: 1 does not lie in 2 to 32768"},
    {"1024", "18446744073709551615", "projector.width: not an integer"},
    {"1024", "-1024", "projector.width: -1024 does not lie in 2 to 32768"},
    {"\"frames\"", "\"pictures\"", "frames: missing"},
    // the frames
    {"\"a.png\"", "5", "frames[5].file: not a string"},
    {"\"a.png\"", "\"\"", "frames[5].file: not a plain file name inside the folder"},
    {"\"a.png\"", "\"..\"", "frames[5].file: not a plain file name inside the folder"},
    {"\"a.png\"", "\"../a.png\"", "frames[5].file: not a plain file name inside the folder"},
    {"\"a.png\"", "\"/etc/passwd\"", "frames[5].file: not a plain file name inside the folder"},
    {"\"a.png\"", "\"x\\\\a.png\"", "frames[5].file: not a plain file name inside the folder"},
    {"\"a.png\"", "\"a\\u0000.png\"", "frames[5].file: not a plain file name inside the folder"},
    {"\"file\": \"a.png\", ", "", "frames[5].file: missing"},
    {"{\"file\": \"a.png\", \"pattern\": \"white\"}", "7", "frames[5]: not an object"},
    {"\"pattern\": \"white\"", "\"shows\": \"white\"", "frames[5].pattern: missing"},
    {"\"white\"", "\"stripes\"",
     "frames[5].pattern: \"stripes\" is not a pattern that can be decoded (white, black, gray, phase)"},
    {"\"axis\": \"row\"", "\"axis\": \"diagonal\"", "frames[0].axis: \"diagonal\" is neither row nor column"},
    {"\"axis\": \"row\", ", "", "frames[0].axis: missing"},
    {"\"bit\": 0, ", "", "frames[0].bit: missing"},
    {"\"bit\": 0", "\"bit\": 2", "frames[0].bit: 2 does not exist for 3 rows"},
    {"\"bit\": 0", "\"bit\": -1", "frames[0].bit: -1 does not exist for 3 rows"},
    {"\"bit\": 0", "\"bit\": 4294967296", "frames[0].bit: 4294967296 does not exist for 3 rows"},
    {"\"axis\": \"row\", \"bit\": 0", "\"axis\": \"column\", \"bit\": 10",
     "frames[0].bit: 10 does not exist for 1024 columns"},
    {"\"bit\": 0", "\"bit\": 0.5", "frames[0].bit: not an integer"},
    {"\"inverted\": true", "\"inverted\": 1", "frames[0].inverted: not true or false"},
    {"\"timestamp_us\": -5", "\"timestamp_us\": \"now\"", "frames[1].timestamp_us: not an integer"},
    // what the frames add up to
    {"\"pattern\": \"black\"", "\"pattern\": \"white\"", "frames[5]: white again, after frames[3]"},
    {"\"bit\": 0, \"inverted\": true", "\"bit\": 1, \"inverted\": true",
     "frames[2]: gray row bit 1 inverted again, after frames[0]"},
    {",\n    {\"file\": \"a.png\", \"pattern\": \"white\"}", "", "frames: white is missing"},
    {"    {\"file\": \"b.png\", \"pattern\": \"black\"},\n", "", "frames: black is missing"},
    {"    {\"file\": \"c.png\", \"pattern\": \"gray\", \"axis\": \"row\", \"bit\": 1, \"inverted\": "
     "false},\n",
     "", "frames: gray row bit 1 is missing"},
    {"    {\"file\": \"f.png\", \"pattern\": \"gray\", \"axis\": \"row\", \"bit\": 0, \"inverted\": true},\n",
     "", "frames: gray row bit 0 inverted is missing (other inverses are there)"},
    // optional keys
    {"2.2", "\"log\"", "response: neither \"srgb\", \"linear\" nor a gamma"},
    {"2.2", "true", "response: neither \"srgb\", \"linear\" nor a gamma"},
    {"2.2", "0", "response: must be positive"},
    {"\"Nikon D5000\"", "5", "camera: not a string"},
    {"16666.7", "\"1/60\"", "exposure_us: not a number"},
    {"\"iso\": 200", "\"iso\": -200", "iso: must be positive"},
    {"5.6", "null", "aperture: not a number"},
    {"\"2026-03-01T10:00:00Z\"", "2026", "captured_at: not a string"},
};

TEST(ParseManifest, NamesEveryDamage) {
  for (const Damage& damage : damages)
    EXPECT_EQ(message(replaced(damage.from, damage.to)), "capture.json: " + std::string(damage.message))
        << damage.to;
}

TEST(ParseManifest, NamesAWrongShape) {
  EXPECT_EQ(message("[]"), "capture.json: not a JSON object");
  EXPECT_EQ(message(R"({"format": "bodyscan-capture", "version": 1, "projector": {"width": 4, "height": 4},
                        "frames": {}})"),
            "capture.json: frames: not an array");
  EXPECT_EQ(message(R"({"format": "bodyscan-capture", "version": 1, "projector": {"width": 4, "height": 4},
                        "frames": [{"file": "a", "pattern": "white"}, {"file": "b", "pattern": "black"}]})"),
            "capture.json: frames: there is no gray pattern");
}

TEST(ParseManifest, ATextThatIsNoJsonSaysWhere) {
  EXPECT_EQ(message("{\"format\": ").substr(0, 58),
            "capture.json: parse error at line 1, column 12: syntax err");
  EXPECT_NE(message(""), "accepted");
  EXPECT_NE(message("{\"format\": \"\xff\"}"), "accepted");
  EXPECT_NE(message("{\"version\": 1e999}"), "accepted");
  for (std::size_t length = 0; length < good.size(); ++length)
    ASSERT_NE(message(std::string(good.substr(0, length))), "accepted") << length;
}

TEST(ParseManifest, SurvivesDeepNestingAndRefusesALongText) {
  EXPECT_NE(message(std::string(1 << 19, '[')), "accepted");
  EXPECT_EQ(message(std::string(1 << 19, '[') + std::string(1 << 19, ']')),
            "capture.json: not a JSON object");
  EXPECT_EQ(message(std::string((1 << 20) + 1, ' ')), "capture.json: over the limit of 1048576 bytes");
}

TEST(WriteManifest, ReadsBackEqual) {
  const auto path = std::filesystem::path(testing::TempDir()) / "bodyscan_manifest.json";
  CaptureManifest manifest = parse_manifest(good, "").value();
  for (const ToneResponse response : {ToneResponse{ToneResponse::Kind::gamma, 2.2},
                                      ToneResponse{ToneResponse::Kind::linear}, ToneResponse{}}) {
    manifest.response = response;
    ASSERT_TRUE(write_manifest(manifest, path));
    const auto read = parse_manifest(as_text(read_file(path, max_manifest_bytes).value()), "written");
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->projector, manifest.projector);
    EXPECT_EQ(read->response, response);
    EXPECT_EQ(read->camera, manifest.camera);
    EXPECT_EQ(read->exposure_us, manifest.exposure_us);
    EXPECT_EQ(read->iso, manifest.iso);
    EXPECT_EQ(read->aperture, manifest.aperture);
    EXPECT_EQ(read->captured_at, manifest.captured_at);
    ASSERT_EQ(read->frames.size(), manifest.frames.size());
    for (std::size_t i = 0; i < read->frames.size(); ++i) {
      EXPECT_EQ(read->frames[i].file, manifest.frames[i].file);
      EXPECT_EQ(read->frames[i].pattern, manifest.frames[i].pattern);
      EXPECT_EQ(read->frames[i].timestamp_us, manifest.frames[i].timestamp_us);
    }
  }
  std::filesystem::remove(path);
}

TEST(WriteManifest, AFolderThatIsNotThereIsAnOutputError) {
  const auto written = write_manifest(parse_manifest(good, "").value(), "/nonexistent/capture.json");
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().kind, ErrorKind::output);
}

}  // namespace
}  // namespace bodyscan
