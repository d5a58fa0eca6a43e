# cmake -DSOURCE=dir -DVERSION=x.y.z -DOUTPUT=file -P BodyscanVersion.cmake
# Writes a source file that defines the software's version: the project's, and the commit where there is one.
# The file changes only when the version does, so only that one file is ever compiled again.
execute_process(COMMAND git -C ${SOURCE} rev-parse --show-toplevel
                OUTPUT_VARIABLE checkout OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
set(commit "")
if(checkout STREQUAL SOURCE)
  execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --abbrev=10 --exclude=*
                  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
if(commit)
  set(VERSION "${VERSION}+${commit}")
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT [[
#include "app/version.hpp"

namespace bodyscan {

std::string_view software_version() { return "bodyscan @VERSION@"; }

}  // namespace bodyscan
]] @ONLY)
