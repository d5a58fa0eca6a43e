#include "hal/gphoto2/worker_message.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>
#include <utility>

namespace bodyscan::gphoto2 {
namespace {

constexpr std::size_t max_text_bytes = 512;
constexpr std::size_t max_entries = 32;
constexpr int max_picture_side = 100'000;

class Writer {
 public:
  template <class Number>
  std::enable_if_t<std::is_arithmetic_v<Number>> operator()(const Number& number) {
    append(&number, sizeof number);
  }
  void operator()(const std::string& text) {
    const auto length = static_cast<std::uint32_t>(std::min(text.size(), max_text_bytes));
    (*this)(length);
    append(text.data(), length);
  }
  template <class Entry>
  void operator()(const std::vector<Entry>& entries) {
    const auto count = static_cast<std::uint32_t>(std::min(entries.size(), max_entries));
    (*this)(count);
    for (std::uint32_t i = 0; i < count; ++i) fields(*this, entries[i]);
  }

  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  void append(const void* data, std::size_t count) {
    const auto* first = static_cast<const std::byte*>(data);
    bytes_.insert(bytes_.end(), first, first + count);
  }

  std::vector<std::byte> bytes_;
};

// Once something does not fit, everything read after it stays as it was and `complete` is false.
class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : rest_(bytes) {}

  template <class Number>
  std::enable_if_t<std::is_arithmetic_v<Number>> operator()(Number& number) {
    take(&number, sizeof number);
  }
  void operator()(bool& flag) {
    std::uint8_t byte = 0;
    (*this)(byte);
    require(byte <= 1);
    flag = byte == 1;
  }
  void operator()(std::string& text) {
    const std::uint32_t length = count_up_to(max_text_bytes);
    if (!require(length <= rest_.size())) return;
    text.resize(length);
    take(text.data(), length);
    for (char& character : text)
      if (static_cast<unsigned char>(character) < ' ' || character == '\x7f') character = ' ';
  }
  template <class Entry>
  void operator()(std::vector<Entry>& entries) {
    entries.resize(count_up_to(max_entries));
    for (Entry& entry : entries) fields(*this, entry);
  }

  bool require(bool condition) {
    sound_ = sound_ && condition;
    return sound_;
  }
  [[nodiscard]] bool complete() const { return sound_ && rest_.empty(); }

 private:
  std::uint32_t count_up_to(std::size_t limit) {
    std::uint32_t count = 0;
    (*this)(count);
    return require(count <= limit) ? count : 0;
  }
  void take(void* data, std::size_t count) {
    if (count == 0 || !require(count <= rest_.size())) return;
    std::memcpy(data, rest_.data(), count);
    rest_ = rest_.subspan(count);
  }

  std::span<const std::byte> rest_;
  bool sound_ = true;
};

// The fields of every message, once for both directions.
template <class Archive>
void fields(Archive& archive, const std::string& text) {
  archive(text);
}
template <class Archive>
void fields(Archive& archive, std::string& text) {
  archive(text);
}

template <class Message, class Plain>
concept Is = std::is_same_v<std::remove_const_t<Message>, Plain>;

template <class Message>
concept Empty = std::is_empty_v<Message>;

template <class Archive>
void fields(Archive& /*archive*/, Empty auto& /*message*/) {}

template <class Archive>
void fields(Archive& archive, Is<OpenCamera> auto& message) {
  archive(message.port);
}

template <class Archive>
void fields(Archive& archive, Is<CameraSettings> auto& settings) {
  archive(settings.exposure_us);
  archive(settings.iso);
  archive(settings.aperture);
  archive(settings.picture.width);
  archive(settings.picture.height);
}

template <class Archive>
void fields(Archive& archive, Is<Configure> auto& message) {
  fields(archive, message.wanted);
}

template <class Archive>
void fields(Archive& archive, Is<FoundCamera> auto& camera) {
  archive(camera.model);
  archive(camera.port);
}

template <class Archive>
void fields(Archive& archive, Is<CamerasFound> auto& message) {
  archive(message.cameras);
}

template <class Archive>
void fields(Archive& archive, Is<Opened> auto& message) {
  archive(message.identity.model);
  archive(message.identity.serial);
  archive(message.identity.problems);
  archive(message.port);
}

template <class Archive>
void fields(Archive& archive, Is<Configured> auto& message) {
  fields(archive, message.settings);
}

template <class Archive>
void fields(Archive& archive, Is<PictureReady> auto& message) {
  archive(message.bytes);
  archive(message.exposure_end_us);
}

template <class Archive>
void fields(Archive& archive, Is<Failure> auto& message) {
  archive(message.lost);
  archive(message.message);
}

bool plausible(const CameraSettings& settings) {
  const auto side = [](int pixels) { return pixels >= 0 && pixels <= max_picture_side; };
  return settings.exposure_us > 0 && settings.iso >= 0 && std::isfinite(settings.aperture) &&
         settings.aperture >= 0 && side(settings.picture.width) && side(settings.picture.height);
}
bool plausible(const Configure& message) {
  return plausible(message.wanted);
}
bool plausible(const Configured& message) {
  return plausible(message.settings);
}
bool plausible(const PictureReady& message) {
  return message.bytes > 0 && message.bytes <= max_picture_bytes && message.exposure_end_us >= 0;
}
template <class Message>
bool plausible(const Message& /*message*/) {
  return true;
}

template <class Variant>
std::vector<std::byte> encode_variant(std::uint32_t number, const Variant& variant) {
  Writer writer;
  writer(number);
  writer(static_cast<std::uint32_t>(variant.index()));
  std::visit([&](const auto& message) { fields(writer, message); }, variant);
  return writer.take();
}

// Makes `variant` hold its alternative of that index, empty.
template <class Variant, std::size_t... Index>
bool select(Variant& variant, std::uint32_t wanted, std::index_sequence<Index...> /*all*/) {
  return ((wanted == Index && (variant.template emplace<Index>(), true)) || ...);
}

template <class Variant>
std::optional<Numbered<Variant>> decode_variant(std::span<const std::byte> bytes) {
  Reader reader(bytes);
  Numbered<Variant> result;
  std::uint32_t index = std::variant_size_v<Variant>;
  reader(result.number);
  reader(index);
  if (!select(result.message, index, std::make_index_sequence<std::variant_size_v<Variant>>())) return {};
  const bool sound = std::visit(
      [&](auto& message) {
        fields(reader, message);
        return reader.complete() && plausible(message);
      },
      result.message);
  if (!sound) return {};
  return result;
}

}  // namespace

std::vector<std::byte> encode(std::uint32_t number, const Request& request) {
  return encode_variant(number, request);
}

std::vector<std::byte> encode(std::uint32_t number, const Reply& reply) {
  return encode_variant(number, reply);
}

std::optional<Numbered<Request>> decode_request(std::span<const std::byte> bytes) {
  return decode_variant<Request>(bytes);
}

std::optional<Numbered<Reply>> decode_reply(std::span<const std::byte> bytes) {
  return decode_variant<Reply>(bytes);
}

}  // namespace bodyscan::gphoto2
