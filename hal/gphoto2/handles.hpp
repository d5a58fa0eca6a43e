#pragma once

#include <memory>
#include <new>

#include <gphoto2/gphoto2.h>

namespace bodyscan::gphoto2 {

// libgphoto2's objects, owned. Making one fails only where memory is out.
template <class Object, auto destroy>
struct Destroy {
  void operator()(Object* object) const { destroy(object); }
};
template <class Object, auto destroy>
using Handle = std::unique_ptr<Object, Destroy<Object, destroy>>;

using ContextHandle = Handle<GPContext, gp_context_unref>;
using CameraHandle = Handle<::Camera, gp_camera_unref>;
using AbilitiesHandle = Handle<CameraAbilitiesList, gp_abilities_list_free>;
using PortsHandle = Handle<GPPortInfoList, gp_port_info_list_free>;
using ListHandle = Handle<::CameraList, gp_list_unref>;
using FileHandle = Handle<::CameraFile, gp_file_unref>;
using WidgetHandle = Handle<::CameraWidget, gp_widget_free>;

template <class OwnedHandle, class Create>
OwnedHandle make_handle(Create create) {
  typename OwnedHandle::pointer object = nullptr;
  if (create(&object) < GP_OK) throw std::bad_alloc();
  return OwnedHandle(object);
}

}  // namespace bodyscan::gphoto2
