#include "hal/gphoto2/scan_settings.hpp"

#include "hal/gphoto2/setting_text.hpp"
#include "pipeline/base/number_text.hpp"
#include "pipeline/base/size_text.hpp"

#include <algorithm>
#include <cmath>

namespace bodyscan::gphoto2 {
namespace {

using Meaning = std::optional<double> (*)(std::string_view);

// What would change pictures behind the scan's back, and the value that does not. Best effort: not every
// camera has them all or lets the computer set them.
struct Steady {
  const char* name;
  const char* value;
};
constexpr Steady steady_settings[] = {
    {"autoiso", "Off"},   {"isoauto", "Off"}, {"flashmode", "Flash off"}, {"capturemode", "Single Shot"},
    {"longexpnr", "Off"},
};

Outcome<void> settle(Session& session, const char* name, const char* value) {
  const auto setting = session.setting(name);
  if (!setting) return tl::unexpected(setting.error());
  if (!*setting || (*setting)->read_only || (*setting)->value == value || !(*setting)->offers(value))
    return {};
  if (auto set = session.set(name, value); !set && set.error().lost) return set;
  return {};
}

// Automatic white balance would give every pattern other colours.
Outcome<void> fix_white_balance(Session& session) {
  const auto setting = session.setting("whitebalance");
  if (!setting) return tl::unexpected(setting.error());
  if (!*setting || !(*setting)->value.starts_with("Auto")) return {};
  return settle(session, "whitebalance", "Daylight");
}

tl::unexpected<Failure> cannot_set(const std::string& what) {
  return refused("the " + what + " cannot be set from the computer: check that the mode dial is on M");
}

// Sets a choice that the scan cannot do without, and reads it back.
Outcome<std::string> choose(Session& session, const Setting& setting, const std::string& what,
                            const std::string& choice) {
  if (setting.value == choice) return choice;
  if (setting.read_only) return cannot_set(what);
  if (auto set = session.set(setting.name, choice); !set)
    return set.error().lost ? tl::unexpected(set.error()) : cannot_set(what);
  auto now = session.setting(setting.name.c_str());
  if (!now) return tl::unexpected(now.error());
  if (!*now) return cannot_set(what);
  return (*now)->value;
}

// The number that was really set; nothing where the camera has no such setting.
Outcome<std::optional<double>> choose_nearest(Session& session, const std::vector<const char*>& names,
                                              const std::string& what, double wanted, Meaning meaning) {
  const auto setting = session.first_setting(names);
  if (!setting) return tl::unexpected(setting.error());
  if (!*setting) return std::nullopt;
  const auto nearest = nearest_choice((*setting)->choices, wanted, meaning);
  if (!nearest) {
    if (const auto fixed = meaning((*setting)->value)) return fixed;
    return cannot_set(what);
  }
  const auto chosen = choose(session, **setting, what, *nearest);
  if (!chosen) return tl::unexpected(chosen.error());
  const auto value = meaning(*chosen);
  if (!value) return refused("the " + what + " reads \"" + *chosen + "\"");
  return value;
}

Outcome<void> send_pictures_to_computer(Session& session) {
  const auto target = session.setting("capturetarget");
  if (!target) return tl::unexpected(target.error());
  if (*target && (*target)->offers("Internal RAM"))
    if (auto set = session.set("capturetarget", "Internal RAM"); !set) return set;
  const auto autofocus = session.setting("autofocus");
  if (!autofocus) return tl::unexpected(autofocus.error());
  // Unset it reads "On" and captures with it off, so it is set whatever it reads.
  if (*autofocus && (*autofocus)->offers("Off")) return session.set("autofocus", "Off");
  return {};
}

Outcome<void> choose_jpeg(Session& session) {
  const auto setting = session.first_setting({"imagequality", "imageformat"});
  if (!setting) return tl::unexpected(setting.error());
  if (!*setting) return {};
  const auto best = best_jpeg((*setting)->choices);
  if (!best) return refused("it offers no JPEG pictures");
  const auto chosen = choose(session, **setting, "picture quality", *best);
  if (!chosen) return tl::unexpected(chosen.error());
  return {};
}

// The size set; 0 x 0 where the camera does not tell.
Outcome<Size> choose_size(Session& session, Size wanted) {
  const auto setting = session.setting("imagesize");
  if (!setting) return tl::unexpected(setting.error());
  if (!*setting) return Size{};
  std::optional<std::string> choice;
  Size best;
  std::string offered;
  for (const std::string& text : (*setting)->choices) {
    const auto size = picture_size(text);
    if (!size) continue;
    offered += (offered.empty() ? "" : ", ") + text_of(*size);
    const bool better = wanted == Size{} ? size->area() > best.area() : *size == wanted;
    if (!better) continue;
    best = *size;
    choice = text;
  }
  if (!choice && wanted != Size{})
    return refused("it has no pictures of " + text_of(wanted) + " pixels, but " + offered);
  if (!choice) return picture_size((*setting)->value).value_or(Size{});
  const auto chosen = choose(session, **setting, "picture size", *choice);
  if (!chosen) return tl::unexpected(chosen.error());
  return picture_size(*chosen).value_or(Size{});
}

}  // namespace

Outcome<bool> dial_is_manual(Session& session) {
  const auto program = session.first_setting({"expprogram", "autoexposuremode"});
  if (!program) return tl::unexpected(program.error());
  return !*program || (*program)->value == "M" || (*program)->value == "Manual";
}

Outcome<std::optional<Setting>> aperture_setting(Session& session) {
  return session.first_setting({"f-number", "aperture"});
}

Outcome<CameraSettings> apply_scan_settings(Session& session, const CameraSettings& wanted) {
  const auto manual = dial_is_manual(session);
  if (!manual) return tl::unexpected(manual.error());
  if (!*manual) return refused(dial_problem);
  if (const auto sent = send_pictures_to_computer(session); !sent) return tl::unexpected(sent.error());
  for (const Steady& steady : steady_settings)
    if (const auto settled = settle(session, steady.name, steady.value); !settled)
      return tl::unexpected(settled.error());
  if (const auto fixed = fix_white_balance(session); !fixed) return tl::unexpected(fixed.error());
  if (const auto jpeg = choose_jpeg(session); !jpeg) return tl::unexpected(jpeg.error());

  const auto picture = choose_size(session, wanted.picture);
  if (!picture) return tl::unexpected(picture.error());
  const auto sensitivity = choose_nearest(session, {"iso"}, "sensitivity (ISO)", wanted.iso, iso);
  if (!sensitivity) return tl::unexpected(sensitivity.error());
  const auto aperture =
      choose_nearest(session, {"f-number", "aperture"}, "aperture", wanted.aperture, f_number);
  if (!aperture) return tl::unexpected(aperture.error());
  // The first is exact fractions, the second decimals of them.
  const auto exposure = choose_nearest(session, {"shutterspeed2", "shutterspeed"}, "exposure time",
                                       wanted.exposure_us * 1e-6, exposure_seconds);
  if (!exposure) return tl::unexpected(exposure.error());
  if (!*exposure)
    return refused("its exposure time cannot be set from a computer: it is no camera for scans");

  CameraSettings set;
  set.exposure_us = static_cast<int>(std::clamp(std::lround(**exposure * 1e6), 1L, 2'000'000'000L));
  set.iso = static_cast<int>(std::lround(sensitivity->value_or(0)));
  set.aperture = aperture->value_or(0);
  set.picture = *picture;
  return set;
}

}  // namespace bodyscan::gphoto2
