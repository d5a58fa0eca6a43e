#include "tools/simulator/serve/camera.hpp"

#include <algorithm>
#include <span>

// What a D5000 answers to each operation.
namespace bodyscan::simulator {
namespace {

using ptp::EventCode;
using ptp::ObjectFormat;
using ptp::Operation;
using ptp::PropertyCode;
using ptp::Request;
using ptp::Response;
using ptp::ResponseCode;

constexpr std::uint32_t every_storage = 0xFFFFFFFF;
constexpr std::uint32_t nikon_extension = 10;  // vendor extension IDs, ISO 15740, annex

const std::vector<Operation>& operations() {
  static const std::vector<Operation> all{
      Operation::get_device_info,
      Operation::open_session,
      Operation::close_session,
      Operation::get_storage_ids,
      Operation::get_storage_info,
      Operation::get_num_objects,
      Operation::get_object_handles,
      Operation::get_object_info,
      Operation::get_object,
      Operation::get_thumb,
      Operation::delete_object,
      Operation::initiate_capture,
      Operation::get_device_prop_desc,
      Operation::get_device_prop_value,
      Operation::set_device_prop_value,
      Operation::get_partial_object,
      Operation::nikon_initiate_capture_rec_in_sdram,
      Operation::nikon_af_drive,
      Operation::nikon_change_camera_mode,
      Operation::nikon_del_image_sdram,
      Operation::nikon_get_event,
      Operation::nikon_device_ready,
      Operation::nikon_get_vendor_prop_codes,
      Operation::nikon_af_capture_sdram,
      Operation::nikon_start_live_view,
      Operation::nikon_end_live_view,
      Operation::nikon_get_live_view_img,
      Operation::nikon_mf_drive,
      Operation::nikon_change_af_area,
      Operation::nikon_af_drive_cancel,
  };
  return all;
}

Response data_or(const std::optional<ptp::Bytes>& data, ResponseCode otherwise) {
  return data ? ptp::with_data(*data) : Response{otherwise};
}

}  // namespace

Response Camera::device_info() const {
  constexpr std::uint16_t standard_version = 100;
  constexpr std::uint16_t standard_mode = 0;
  const std::vector<EventCode> events{EventCode::object_added,
                                      EventCode::object_removed,
                                      EventCode::device_prop_changed,
                                      EventCode::capture_complete,
                                      EventCode::nikon_object_added_in_sdram,
                                      EventCode::nikon_capture_complete_rec_in_sdram};
  const std::vector<ObjectFormat> captured{ObjectFormat::exif_jpeg, ObjectFormat::undefined};
  const std::vector<ObjectFormat> stored{ObjectFormat::exif_jpeg, ObjectFormat::undefined,
                                         ObjectFormat::association};
  return ptp::with_data(ptp::DatasetWriter()
                            .put(standard_version)
                            .put(nikon_extension)
                            .put(standard_version)
                            .text("microsoft.com: 1.0")
                            .put(standard_mode)
                            .array(operations())
                            .array(events)
                            .array(settings_.codes())
                            .array(captured)
                            .array(stored)
                            .text("Nikon Corporation")
                            .text("D5000")
                            .text("V1.00")
                            .text("6000001")
                            .take());
}

Response Camera::answer_in_session(const Request& request, Moment now) {
  const auto& parameters = request.parameters;
  switch (request.operation) {
    case Operation::close_session:
      session_ = 0;
      return switch_live_view(false);
    case Operation::get_storage_ids:
      return ptp::with_data(ptp::DatasetWriter().array(std::vector{ObjectStore::storage}).take());
    case Operation::get_storage_info:
      if (parameters[0] != ObjectStore::storage) return {ResponseCode::invalid_storage_id};
      return ptp::with_data(storage_info(objects_));
    case Operation::get_num_objects:
    case Operation::get_object_handles: {
      if (parameters[0] != ObjectStore::storage && parameters[0] != every_storage)
        return {ResponseCode::invalid_storage_id};
      const std::vector<std::uint32_t> handles = objects_.handles(parameters[1], parameters[2]);
      if (request.operation == Operation::get_num_objects)
        return {ResponseCode::ok, {static_cast<std::uint32_t>(handles.size())}};
      return ptp::with_data(ptp::DatasetWriter().array(handles).take());
    }
    case Operation::get_object_info:
    case Operation::get_object:
    case Operation::get_thumb:
    case Operation::get_partial_object:
    case Operation::delete_object:
      return answer_about_object(request);
    case Operation::get_device_prop_desc:
    case Operation::get_device_prop_value:
    case Operation::set_device_prop_value:
      return answer_about_property(request);
    case Operation::initiate_capture:
      return capture(Target::card, now);
    case Operation::nikon_initiate_capture_rec_in_sdram:
    case Operation::nikon_af_capture_sdram:
      return capture(Target::ram, now);
    case Operation::nikon_device_ready:
      return {shutter_ == Shutter::exposing ? ResponseCode::device_busy : ResponseCode::ok};
    case Operation::nikon_get_event:
      return queued_events();
    case Operation::nikon_del_image_sdram:
      objects_.remove(ObjectStore::ram_handle);
      return {};
    case Operation::nikon_get_vendor_prop_codes:
      return ptp::with_data(ptp::DatasetWriter().array(std::vector<PropertyCode>{}).take());
    case Operation::nikon_start_live_view:
      return switch_live_view(true);
    case Operation::nikon_end_live_view:
      return switch_live_view(false);
    case Operation::nikon_get_live_view_img:
      return live_view_image(now);
    case Operation::nikon_change_camera_mode:  // there is no focus motor: nothing to do
    case Operation::nikon_af_drive:
    case Operation::nikon_mf_drive:
    case Operation::nikon_change_af_area:
    case Operation::nikon_af_drive_cancel:
      return {};
    default:
      return {ResponseCode::operation_not_supported};
  }
}

Response Camera::answer_about_object(const Request& request) {
  const ObjectStore::Object* object = objects_.find(request.parameters[0]);
  if (object == nullptr) return {ResponseCode::invalid_object_handle};
  if (request.operation == Operation::get_object_info) return ptp::with_data(object_info(*object));
  if (request.operation == Operation::delete_object)
    return {objects_.remove(request.parameters[0]) ? ResponseCode::ok : ResponseCode::access_denied};
  if (object->photo.jpeg == nullptr) return {ResponseCode::invalid_object_handle};
  if (request.operation == Operation::get_object) return {ResponseCode::ok, {}, object->photo.jpeg};
  if (request.operation == Operation::get_thumb) return {ResponseCode::ok, {}, object->photo.thumbnail};

  const std::span<const std::uint8_t> jpeg = *object->photo.jpeg;
  const std::size_t begin = request.parameters[1];
  if (begin > jpeg.size()) return {ResponseCode::invalid_parameter};
  const auto part = jpeg.subspan(begin, std::min<std::size_t>(request.parameters[2], jpeg.size() - begin));
  Response response = ptp::with_data({part.begin(), part.end()});
  response.parameters = {static_cast<std::uint32_t>(part.size())};
  return response;
}

Response Camera::answer_about_property(const Request& request) {
  const auto code = static_cast<PropertyCode>(request.parameters[0]);
  if (request.operation == Operation::get_device_prop_desc)
    return data_or(settings_.description(code), ResponseCode::device_prop_not_supported);
  if (request.operation == Operation::get_device_prop_value)
    return data_or(settings_.value(code), ResponseCode::device_prop_not_supported);
  return {settings_.set(code, request.data)};
}

}  // namespace bodyscan::simulator
