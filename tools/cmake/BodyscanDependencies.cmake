# Debian's packages, as static archives by explicit path (docs/decisions.md says why).
set(BODYSCAN_ARCHIVES /usr/lib/${CMAKE_LIBRARY_ARCHITECTURE})

find_package(Threads REQUIRED)

function(bodyscan_archive target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "ARCHIVES;INCLUDES;USES")
  add_library(${target} INTERFACE IMPORTED GLOBAL)
  foreach(archive ${arg_ARCHIVES})
    if(NOT EXISTS ${BODYSCAN_ARCHIVES}/${archive})
      message(FATAL_ERROR "${BODYSCAN_ARCHIVES}/${archive} is missing: run tools/setup")
    endif()
    target_link_libraries(${target} INTERFACE ${BODYSCAN_ARCHIVES}/${archive})
  endforeach()
  target_include_directories(${target} SYSTEM INTERFACE ${arg_INCLUDES})
  target_link_libraries(${target} INTERFACE ${arg_USES})
endfunction()

bodyscan_archive(ext::zlib ARCHIVES libz.a)
bodyscan_archive(ext::png ARCHIVES libpng16.a USES ext::zlib)
bodyscan_archive(ext::jpeg ARCHIVES libjpeg.a)
# The one shared library: its camera drivers are loaded at run time.
add_library(ext::gphoto2 INTERFACE IMPORTED GLOBAL)
target_link_libraries(ext::gphoto2 INTERFACE gphoto2 gphoto2_port)
if(NOT EXISTS ${BODYSCAN_ARCHIVES}/libgphoto2.so)
  message(FATAL_ERROR "${BODYSCAN_ARCHIVES}/libgphoto2.so is missing: run tools/setup")
endif()
bodyscan_archive(ext::drm ARCHIVES libdrm.a INCLUDES /usr/include/libdrm)
bodyscan_archive(ext::eigen INCLUDES /usr/include/eigen3)
bodyscan_archive(ext::json)   # nlohmann, header-only
bodyscan_archive(ext::cli11)  # header-only
bodyscan_archive(ext::toml)   # toml++, header-only
bodyscan_archive(ext::expected)  # tl::expected, header-only
