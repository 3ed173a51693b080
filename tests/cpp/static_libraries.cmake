# The libraries that a static link needs are those that docs/abi.md and the compiler name.
file(READ "${ROOT}/target/static_libraries.log" log)
string(REGEX MATCH "native-static-libs: ([^\n]*)" found "${log}")
if(NOT EXPECTED OR NOT CMAKE_MATCH_1 STREQUAL EXPECTED)
    message(FATAL_ERROR "the compiler names '${CMAKE_MATCH_1}', docs/abi.md '${EXPECTED}'")
endif()
