#include "hal/gphoto2/session.hpp"

#include <algorithm>
#include <cstdlib>
#include <string_view>
#include <utility>

namespace bodyscan::gphoto2 {
namespace {

constexpr const char* network_model = "PTP/IP Camera";

// The link or the camera is gone, rather than a request refused.
bool is_lost(int result) {
  switch (result) {
    case GP_ERROR_IO:
    case GP_ERROR_TIMEOUT:
    case GP_ERROR_CORRUPTED_DATA:
    case GP_ERROR_OS_FAILURE:
      return true;
    default:
      return result <= GP_ERROR_IO_INIT && result >= GP_ERROR_HAL;
  }
}

std::string reason_of(int result) {
  switch (result) {
    case GP_ERROR_IO_USB_CLAIM:
      return "another program is using it";
    case GP_ERROR_IO_USB_FIND:
      return "it is not plugged in any more";
    case GP_ERROR_CAMERA_BUSY:
      return "it is busy";
    default:
      return gp_result_as_string(result);
  }
}

AbilitiesHandle load_abilities(GPContext* context) {
  auto abilities = make_handle<AbilitiesHandle>(gp_abilities_list_new);
  gp_abilities_list_load(abilities.get(), context);
  return abilities;
}

PortsHandle load_ports() {
  auto ports = make_handle<PortsHandle>(gp_port_info_list_new);
  gp_port_info_list_load(ports.get());
  return ports;
}

std::vector<FoundCamera> detect(CameraAbilitiesList* abilities, GPPortInfoList* ports, GPContext* context) {
  const auto list = make_handle<ListHandle>(gp_list_new);
  if (gp_abilities_list_detect(abilities, ports, list.get(), context) < GP_OK) return {};
  std::vector<FoundCamera> cameras;
  for (int i = 0; i < gp_list_count(list.get()); ++i) {
    const char* model = nullptr;
    const char* port = nullptr;
    if (gp_list_get_name(list.get(), i, &model) < GP_OK || gp_list_get_value(list.get(), i, &port) < GP_OK)
      continue;
    // Every mounted disk with a picture folder would be a camera too.
    if (std::string_view(port).starts_with("usb:")) cameras.push_back({model, port});
  }
  return cameras;
}

Outcome<FoundCamera> choose(const std::string& port, const std::vector<FoundCamera>& present) {
  if (port.empty()) {
    if (present.empty()) return refused("no camera found: switch it on, check the cable");
    return present.front();
  }
  const auto there = std::find_if(present.begin(), present.end(),
                                  [&](const FoundCamera& camera) { return camera.port == port; });
  if (there == present.end()) return refused("no camera there: switch it on, check the cable");
  return *there;
}

std::string text_value(CameraWidget* widget, CameraWidgetType type) {
  if (type == GP_WIDGET_RADIO || type == GP_WIDGET_MENU || type == GP_WIDGET_TEXT) {
    const char* text = nullptr;
    if (gp_widget_get_value(widget, &text) < GP_OK || text == nullptr) return {};
    return text;
  }
  if (type == GP_WIDGET_TOGGLE) {
    int on = 0;
    if (gp_widget_get_value(widget, &on) < GP_OK) return {};
    return std::to_string(on);
  }
  if (type == GP_WIDGET_RANGE) {
    float number = 0;
    if (gp_widget_get_value(widget, &number) < GP_OK) return {};
    return std::to_string(number);
  }
  return {};
}

}  // namespace

bool Setting::offers(const std::string& choice) const {
  return std::find(choices.begin(), choices.end(), choice) != choices.end();
}

Outcome<std::vector<FoundCamera>> Session::find_cameras() {
  const ContextHandle context(gp_context_new());
  return detect(load_abilities(context.get()).get(), load_ports().get(), context.get());
}

Outcome<Session> Session::open(const std::string& port, std::function<void()> on_progress) {
  Session session;
  session.listener_ = std::make_unique<Listener>(Listener{{}, std::move(on_progress)});
  session.context_.reset(gp_context_new());
  GPContext* context = session.context();
  gp_context_set_error_func(
      context,
      [](GPContext* /*context*/, const char* text, void* data) {
        static_cast<Listener*>(data)->last_error = text;
      },
      session.listener_.get());
  gp_context_set_progress_funcs(
      context, [](GPContext*, float, const char*, void*) -> unsigned { return 0; },
      [](GPContext*, unsigned, float, void* data) { static_cast<Listener*>(data)->on_progress(); },
      [](GPContext*, unsigned, void*) {}, session.listener_.get());

  const AbilitiesHandle abilities = load_abilities(context);
  const PortsHandle ports = load_ports();
  Outcome<FoundCamera> found = FoundCamera{network_model, port};
  if (!port.starts_with("ptpip:")) found = choose(port, detect(abilities.get(), ports.get(), context));
  if (!found) return tl::unexpected(found.error());
  session.found_ = *found;

  CameraAbilities ability{};
  const int model = gp_abilities_list_lookup_model(abilities.get(), found->model.c_str());
  if (model < GP_OK || gp_abilities_list_get_abilities(abilities.get(), model, &ability) < GP_OK)
    return refused("no driver for \"" + found->model + "\": is libgphoto2 installed completely?");
  GPPortInfo info = nullptr;
  const int place = gp_port_info_list_lookup_path(ports.get(), found->port.c_str());
  if (place < GP_OK || gp_port_info_list_get_info(ports.get(), place, &info) < GP_OK)
    return refused("no such port");

  session.camera_ = make_handle<CameraHandle>(gp_camera_new);
  gp_camera_set_abilities(session.camera(), ability);
  gp_camera_set_port_info(session.camera(), info);
  if (const int result = gp_camera_init(session.camera(), context); result < GP_OK)
    return session.failure(result, "cannot be opened");
  session.answering_ = true;
  return session;
}

Session::~Session() {
  if (camera_) gp_camera_exit(camera_.get(), context_.get());
}

Outcome<std::optional<Setting>> Session::setting(const char* name) {
  CameraWidget* raw = nullptr;
  const int result = gp_camera_get_single_config(camera(), name, &raw, context());
  const WidgetHandle widget(raw);
  if (result < GP_OK || !widget) {
    if (is_lost(result)) return failure(result, std::string("reading ") + name);
    return std::nullopt;
  }
  CameraWidgetType type = GP_WIDGET_TEXT;
  gp_widget_get_type(widget.get(), &type);
  Setting setting;
  setting.name = name;
  setting.value = text_value(widget.get(), type);
  int read_only = 0;
  gp_widget_get_readonly(widget.get(), &read_only);
  setting.read_only = read_only != 0;
  if (type != GP_WIDGET_RADIO && type != GP_WIDGET_MENU) return setting;
  for (int i = 0; i < gp_widget_count_choices(widget.get()); ++i) {
    const char* choice = nullptr;
    if (gp_widget_get_choice(widget.get(), i, &choice) >= GP_OK && choice != nullptr)
      setting.choices.emplace_back(choice);
  }
  return setting;
}

Outcome<std::optional<Setting>> Session::first_setting(const std::vector<const char*>& names) {
  for (const char* name : names) {
    Outcome<std::optional<Setting>> found = setting(name);
    if (!found || *found) return found;
  }
  return std::nullopt;
}

Outcome<void> Session::set(const std::string& name, const std::string& value) {
  CameraWidget* raw = nullptr;
  int result = gp_camera_get_single_config(camera(), name.c_str(), &raw, context());
  const WidgetHandle widget(raw);
  if (result >= GP_OK) result = gp_widget_set_value(widget.get(), value.c_str());
  if (result >= GP_OK) result = gp_camera_set_single_config(camera(), name.c_str(), widget.get(), context());
  if (result < GP_OK) return failure(result, "setting " + name + " to " + value);
  return {};
}

Outcome<void> Session::set_switch(const std::string& name, bool on) {
  CameraWidget* raw = nullptr;
  int result = gp_camera_get_single_config(camera(), name.c_str(), &raw, context());
  const WidgetHandle widget(raw);
  const int value = on ? 1 : 0;
  if (result >= GP_OK) result = gp_widget_set_value(widget.get(), &value);
  if (result >= GP_OK) result = gp_camera_set_single_config(camera(), name.c_str(), widget.get(), context());
  if (result < GP_OK) return failure(result, "switching " + name);
  return {};
}

tl::unexpected<Failure> Session::failure(int result, const std::string& doing) {
  std::string message = doing + ": " + reason_of(result);
  if (!listener_->last_error.empty())
    message += " (" + std::exchange(listener_->last_error, std::string()) + ")";
  // A broken network link is told as an unspecified error too.
  const bool lost = is_lost(result) || (answering_ && result == GP_ERROR && !still_answers());
  return tl::unexpected(Failure{lost, std::move(message)});
}

bool Session::still_answers() {
  CameraEventType type = GP_EVENT_UNKNOWN;
  void* data = nullptr;
  const int result = gp_camera_wait_for_event(camera(), 0, &type, &data, context());
  std::free(data);
  listener_->last_error.clear();
  return result >= GP_OK;
}

}  // namespace bodyscan::gphoto2
