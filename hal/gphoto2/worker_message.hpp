#pragma once

#include "hal/camera.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace bodyscan::gphoto2 {

// What the scanner and its camera worker say to each other, one message a datagram, in the machine's byte
// order. Every request has one answer with the request's number: the reply named beside it, or a Failure.

struct ListCameras {};  // CamerasFound
struct OpenCamera {     // Opened
  std::string port;     // empty: the first camera found on USB
};
struct Configure {  // Configured
  CameraSettings wanted;
};
struct Expose {};   // Exposed
struct Fetch {};    // any number of Progress, then PictureReady
struct Preview {};  // the same
using Request = std::variant<ListCameras, OpenCamera, Configure, Expose, Fetch, Preview>;

struct FoundCamera {
  std::string model;
  std::string port;
};
struct CamerasFound {
  std::vector<FoundCamera> cameras;
};
struct Opened {
  CameraIdentity identity;
  std::string port;
};
struct Configured {
  CameraSettings settings;
};
struct Exposed {};
struct Progress {};  // bytes are coming in
// The picture itself is in the memory file attached to the message.
struct PictureReady {
  std::uint64_t bytes = 0;
  std::int64_t exposure_end_us = 0;
};
struct Failure {
  bool lost = false;  // the camera must be opened again
  std::string message;
};
using Reply = std::variant<CamerasFound, Opened, Configured, Exposed, Progress, PictureReady, Failure>;

inline constexpr std::size_t max_message_bytes = 64 * 1024;
inline constexpr std::size_t max_picture_bytes = 64 * 1024 * 1024;

template <class Message>
struct Numbered {
  std::uint32_t number = 0;
  Message message;
};

// Texts are cut after 512 bytes, lists after 32 entries, so that every message fits max_message_bytes.
std::vector<std::byte> encode(std::uint32_t number, const Request& request);
std::vector<std::byte> encode(std::uint32_t number, const Reply& reply);

// Nothing where the bytes are no such message, whole and without anything after it, or a number in it is
// outside what a camera can mean. Control characters in texts become spaces.
std::optional<Numbered<Request>> decode_request(std::span<const std::byte> bytes);
std::optional<Numbered<Reply>> decode_reply(std::span<const std::byte> bytes);

}  // namespace bodyscan::gphoto2
