#pragma once

#include <cstdint>

// Numbers of the Picture Transfer Protocol (ISO 15740:2013, clause in brackets), of its TCP/IP transport
// (CIPA DC-005) and of Nikon's vendor extension, as libgphoto2's ptp.h names them.
namespace bodyscan::simulator::ptp {

enum class Operation : std::uint16_t {  // 10.3
  get_device_info = 0x1001,
  open_session = 0x1002,
  close_session = 0x1003,
  get_storage_ids = 0x1004,
  get_storage_info = 0x1005,
  get_num_objects = 0x1006,
  get_object_handles = 0x1007,
  get_object_info = 0x1008,
  get_object = 0x1009,
  get_thumb = 0x100A,
  delete_object = 0x100B,
  initiate_capture = 0x100E,
  get_device_prop_desc = 0x1014,
  get_device_prop_value = 0x1015,
  set_device_prop_value = 0x1016,
  get_partial_object = 0x101B,
  nikon_initiate_capture_rec_in_sdram = 0x90C0,
  nikon_af_drive = 0x90C1,
  nikon_change_camera_mode = 0x90C2,
  nikon_del_image_sdram = 0x90C3,
  nikon_get_event = 0x90C7,
  nikon_device_ready = 0x90C8,
  nikon_get_vendor_prop_codes = 0x90CA,
  nikon_af_capture_sdram = 0x90CB,
  nikon_start_live_view = 0x9201,
  nikon_end_live_view = 0x9202,
  nikon_get_live_view_img = 0x9203,
  nikon_mf_drive = 0x9204,
  nikon_change_af_area = 0x9205,
  nikon_af_drive_cancel = 0x9206,
};

enum class ResponseCode : std::uint16_t {  // 11.2
  ok = 0x2001,
  general_error = 0x2002,
  session_not_open = 0x2003,
  operation_not_supported = 0x2005,
  invalid_storage_id = 0x2008,
  invalid_object_handle = 0x2009,
  device_prop_not_supported = 0x200A,
  store_full = 0x200C,
  access_denied = 0x200F,
  device_busy = 0x2019,
  invalid_device_prop_format = 0x201B,
  invalid_device_prop_value = 0x201C,
  invalid_parameter = 0x201D,
  session_already_open = 0x201E,
  nikon_not_live_view = 0xA00B,
};

enum class EventCode : std::uint16_t {  // 12.5
  object_added = 0x4002,
  object_removed = 0x4003,
  device_prop_changed = 0x4006,
  capture_complete = 0x400D,
  nikon_object_added_in_sdram = 0xC101,
  nikon_capture_complete_rec_in_sdram = 0xC102,
};

enum class PropertyCode : std::uint16_t {  // 13.3
  battery_level = 0x5001,
  image_size = 0x5003,
  compression_setting = 0x5004,
  white_balance = 0x5005,
  f_number = 0x5007,
  focal_length = 0x5008,
  focus_mode = 0x500A,
  exposure_metering_mode = 0x500B,
  flash_mode = 0x500C,
  exposure_time = 0x500D,
  exposure_program_mode = 0x500E,
  exposure_index = 0x500F,
  exposure_bias_compensation = 0x5010,
  date_time = 0x5011,
  still_capture_mode = 0x5013,
  burst_number = 0x5018,
  nikon_exposure_time = 0xD100,
  nikon_ac_power = 0xD101,
  nikon_recording_media = 0xD10B,
  nikon_autofocus_mode = 0xD161,
  nikon_live_view_status = 0xD1A2,
};

enum class ObjectFormat : std::uint16_t {  // 6.3
  undefined = 0x3000,
  association = 0x3001,
  exif_jpeg = 0x3801,
  jfif = 0x3808,
};

enum class PacketType : std::uint32_t {  // CIPA DC-005, 2.3
  init_command_request = 1,
  init_command_ack = 2,
  init_event_request = 3,
  init_event_ack = 4,
  init_fail = 5,
  operation_request = 6,
  operation_response = 7,
  event = 8,
  start_data = 9,
  data = 10,
  cancel_transaction = 11,
  end_data = 12,
  probe_request = 13,
  probe_response = 14,
};

// What the operation request says about data of its own (CIPA DC-005, 2.3.6).
inline constexpr std::uint32_t data_phase_out = 2;

}  // namespace bodyscan::simulator::ptp
