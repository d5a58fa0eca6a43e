# bodyscan_library(NAME SOURCES file... [USES library...])
# A static library of this tree. USES writes out every dependency: what is not named does not link.
function(bodyscan_library name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;USES")
  add_library(${name} STATIC ${arg_SOURCES})
  target_link_libraries(${name} PUBLIC ${arg_USES})
endfunction()

# bodyscan_test(NAME SOURCES file... [USES library...] [LABELS label...])
# A GoogleTest executable and its entry in ctest.
function(bodyscan_test name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;USES;LABELS")
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE ${arg_USES} GTest::gtest_main)
  add_test(NAME ${name} COMMAND ${name})
  set_tests_properties(${name} PROPERTIES LABELS "${arg_LABELS}" TIMEOUT 600)
endfunction()
