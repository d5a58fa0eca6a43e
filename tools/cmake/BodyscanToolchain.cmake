# Compiler and linker flags of everything in the tree.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DNDEBUG")
set(CMAKE_POSITION_INDEPENDENT_CODE ON)

option(BODYSCAN_SANITIZE "Address and undefined behaviour sanitizers" OFF)
option(BODYSCAN_SANITIZE_THREADS "Thread sanitizer; not together with the others" OFF)

find_program(CCACHE ccache)
if(CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE})
endif()

add_compile_options(-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Werror
                    -march=x86-64-v2 -fno-math-errno -fno-trapping-math -ffunction-sections -fdata-sections)
# clang only: a loop left unvectorised is no error, least of all under sanitizers; kernels combine conditions with
# & and | so that they stay free of branches.
add_compile_options("$<$<CXX_COMPILER_ID:Clang>:-Wno-pass-failed;-Wno-bitwise-instead-of-logical;-Wno-bitwise-conditional-parentheses>")
add_link_options(-static-libstdc++ -static-libgcc -Wl,--gc-sections -Wl,--as-needed -Wl,-z,relro,-z,now
                 -Wl,--exclude-libs,ALL)
include_directories(${CMAKE_SOURCE_DIR})

if(BODYSCAN_SANITIZE OR BODYSCAN_BUILD_FUZZERS)
  add_compile_options(-fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  add_link_options(-fsanitize=address,undefined)
endif()
if(BODYSCAN_SANITIZE_THREADS)
  add_compile_options(-fsanitize=thread -fno-omit-frame-pointer)
  add_link_options(-fsanitize=thread)
endif()
if(BODYSCAN_BUILD_FUZZERS)
  add_compile_options(-fsanitize=fuzzer-no-link)
  add_link_options(-fsanitize=fuzzer-no-link)
endif()
