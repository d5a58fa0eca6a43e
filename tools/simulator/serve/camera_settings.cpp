#include "tools/simulator/serve/camera_settings.hpp"

#include "tools/simulator/serve/ptp/date_time.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace bodyscan::simulator {
namespace {

using ptp::Property;
using ptp::PropertyCode;
using ptp::Value;

struct ShutterTime {  // seconds, as the dial writes them
  unsigned numerator;
  unsigned denominator;

  // Units of 0.1 ms, cut off as Nikon does: the standard's ExposureTime.
  [[nodiscard]] std::uint32_t tenths_of_ms() const { return std::max(1U, 10'000 * numerator / denominator); }
  // Nikon's own property holds the fraction.
  [[nodiscard]] std::uint32_t fraction() const { return numerator << 16 | denominator; }
};

// In thirds of a stop; D5000 reference manual, "Mode M".
constexpr ShutterTime shutter_times[] = {
    {1, 4000}, {1, 3200}, {1, 2500}, {1, 2000}, {1, 1600}, {1, 1250}, {1, 1000}, {1, 800}, {1, 640},
    {1, 500},  {1, 400},  {1, 320},  {1, 250},  {1, 200},  {1, 160},  {1, 125},  {1, 100}, {1, 80},
    {1, 60},   {1, 50},   {1, 40},   {1, 30},   {1, 25},   {1, 20},   {1, 15},   {1, 13},  {1, 10},
    {1, 8},    {1, 6},    {1, 5},    {1, 4},    {1, 3},    {10, 25},  {1, 2},    {10, 16}, {10, 13},
    {1, 1},    {13, 10},  {16, 10},  {2, 1},    {25, 10},  {3, 1},    {4, 1},    {5, 1},   {6, 1},
    {8, 1},    {10, 1},   {13, 1},   {15, 1},   {20, 1},   {25, 1},   {30, 1}};
constexpr ShutterTime standard_time{1, 20};
constexpr std::uint16_t standard_f_number = 800;  // hundredths
constexpr std::uint16_t standard_iso = 200;

// From the 35 mm f/1.8's widest to its narrowest opening, in thirds of a stop.
constexpr std::uint16_t f_numbers[] = {180, 200, 220, 250,  280,  320,  350,  400,  450,  500,  560, 630,
                                       710, 800, 900, 1000, 1100, 1300, 1400, 1600, 1800, 2000, 2200};
constexpr std::uint16_t isos[] = {100,  125,  160,  200,  250,  320,  400,  500,  640, 800,
                                  1000, 1250, 1600, 2000, 2500, 3200, 4000, 5000, 6400};

template <class Number>
std::vector<Value> values(std::initializer_list<Number> numbers) {
  return {numbers.begin(), numbers.end()};
}

template <class Number, std::size_t count>
std::vector<Value> values(const Number (&numbers)[count]) {
  return {std::begin(numbers), std::end(numbers)};
}

Property::Range range(std::uint8_t least, std::uint8_t most) {
  return {least, most, std::uint8_t{1}};
}

std::vector<Value> exposure_biases() {  // thousandths of a stop, -5 to 5
  std::vector<Value> biases;
  for (int third = -15; third <= 15; ++third)
    biases.emplace_back(static_cast<std::int16_t>(third * 1000 / 3));
  return biases;
}

}  // namespace

CameraSettings::CameraSettings(Size picture, bool dial_on_manual) {
  using Byte = std::uint8_t;
  using Short = std::uint16_t;
  constexpr Short manual = 1;
  constexpr Short program = 2;
  const std::string size = std::to_string(picture.width) + "x" + std::to_string(picture.height);
  std::vector<Value> tenths_of_ms;
  std::vector<Value> fractions;
  for (const ShutterTime& time : shutter_times) {
    tenths_of_ms.emplace_back(time.tenths_of_ms());
    fractions.emplace_back(time.fraction());
  }
  constexpr bool read_only = false;
  add({PropertyCode::battery_level, Byte{87}, read_only, {}, range(0, 100)});
  add({PropertyCode::image_size, size, true, {size}});
  add({PropertyCode::compression_setting, Byte{2}, true,
       values<Byte>({0, 1, 2})});  // JPEG basic, normal, fine
  add({PropertyCode::white_balance, Short{2}, true, values<Short>({2, 4, 5, 6, 7, 0x8010, 0x8011, 0x8013})});
  add({PropertyCode::f_number, standard_f_number, dial_on_manual, values(f_numbers)});
  add({PropertyCode::focal_length, std::uint32_t{3500}, read_only});  // hundredths of mm
  add({PropertyCode::focus_mode, Short{1}, read_only, values<Short>({1, 0x8010, 0x8011, 0x8012})});  // manual
  add({PropertyCode::exposure_metering_mode, Short{3}, true, values<Short>({2, 3, 4})});
  add({PropertyCode::flash_mode, Short{2}, true, values<Short>({2, 4, 0x8010})});  // off
  add({PropertyCode::exposure_time, standard_time.tenths_of_ms(), dial_on_manual, tenths_of_ms});
  add({PropertyCode::exposure_program_mode, dial_on_manual ? manual : program, read_only,
       values<Short>({1, 2, 3, 4, 0x8010})});
  add({PropertyCode::exposure_index, standard_iso, true, values(isos)});
  add({PropertyCode::exposure_bias_compensation, std::int16_t{0}, true, exposure_biases()});
  add({PropertyCode::date_time, ptp::date_time_now()});
  add({PropertyCode::still_capture_mode, Short{1}, true, values<Short>({1, 2})});
  add({PropertyCode::burst_number, Short{1}, true, {}, Property::Range{Short{1}, Short{99}, Short{1}}});
  add({PropertyCode::nikon_exposure_time, standard_time.fraction(), dial_on_manual, fractions});
  add({PropertyCode::nikon_ac_power, Byte{1}, read_only, {}, range(0, 1)});
  add({PropertyCode::nikon_recording_media, Byte{0}, true, {}, range(0, 1)});
  add({PropertyCode::nikon_autofocus_mode, Byte{4}, true, {}, range(0, 4)});  // manual
  add({PropertyCode::nikon_live_view_status, Byte{0}, read_only, {}, range(0, 1)});
}

void CameraSettings::add(Property property) {
  const Value factory = property.value;
  const PropertyCode code = property.code;
  entries_.emplace(code, Entry{std::move(property), factory});
}

std::vector<PropertyCode> CameraSettings::codes() const {
  std::vector<PropertyCode> codes;
  for (const auto& [code, entry] : entries_) codes.push_back(code);
  return codes;
}

std::optional<ptp::Bytes> CameraSettings::description(PropertyCode code) const {
  const auto found = entries_.find(code);
  if (found == entries_.end()) return std::nullopt;
  return ptp::describe(found->second.property, found->second.factory);
}

std::optional<ptp::Bytes> CameraSettings::value(PropertyCode code) const {
  const auto found = entries_.find(code);
  if (found == entries_.end()) return std::nullopt;
  return ptp::encode(found->second.property.value);
}

ptp::ResponseCode CameraSettings::set(PropertyCode code, std::span<const std::uint8_t> data) {
  using ptp::ResponseCode;
  const auto found = entries_.find(code);
  if (found == entries_.end()) return ResponseCode::device_prop_not_supported;
  Property& property = found->second.property;
  if (!property.writable) return ResponseCode::access_denied;
  const std::optional<Value> value = ptp::decode(data, property.value);
  if (!value) return ResponseCode::invalid_device_prop_format;
  if (!ptp::allows(property, *value)) return ResponseCode::invalid_device_prop_value;
  property.value = *value;
  const auto couple = [&](PropertyCode other) {
    Property& coupled = entries_.at(other).property;
    const auto place = std::ranges::find(property.choices, *value) - property.choices.begin();
    coupled.value = coupled.choices[static_cast<std::size_t>(place)];
  };
  if (code == PropertyCode::exposure_time) couple(PropertyCode::nikon_exposure_time);
  if (code == PropertyCode::nikon_exposure_time) couple(PropertyCode::exposure_time);
  return ResponseCode::ok;
}

void CameraSettings::show(PropertyCode code, std::uint8_t value) {
  entries_.at(code).property.value = value;
}

template <class Number>
double CameraSettings::number(PropertyCode code) const {
  return std::get<Number>(entries_.at(code).property.value);
}

Clock::duration CameraSettings::exposure_time() const {
  const auto fraction =
      std::get<std::uint32_t>(entries_.at(PropertyCode::nikon_exposure_time).property.value);
  return from_seconds(static_cast<double>(fraction >> 16) / (fraction & 0xFFFF));
}

double CameraSettings::exposure_gain() const {
  constexpr double standard_seconds =
      static_cast<double>(standard_time.numerator) / standard_time.denominator;
  const double aperture = standard_f_number / number<std::uint16_t>(PropertyCode::f_number);
  return seconds(exposure_time()) / standard_seconds *
         (number<std::uint16_t>(PropertyCode::exposure_index) / standard_iso) * aperture * aperture;
}

}  // namespace bodyscan::simulator
