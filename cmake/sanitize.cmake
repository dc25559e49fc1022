# Instrumentation of all libraries and tests, for `catkin_ws/test --sanitize`; needs clang++. The values of
# ENDOVASCULAR_SANITIZE:
#   address   addresses, undefined behaviour, conversions out of range, assertions of the standard library; also coverage
#             of the sources that parse input, and the fuzz targets of test/fuzz
#   thread    data races
# Optimisation and floating-point flags are those of the release build, so that trajectories keep their bits.
set(ENDOVASCULAR_SANITIZE OFF CACHE STRING "Sanitizers: OFF, address or thread")
if(ENDOVASCULAR_SANITIZE)
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    message(FATAL_ERROR "ENDOVASCULAR_SANITIZE needs clang: configure with -DCMAKE_CXX_COMPILER=clang++")
  endif()
  if(ENDOVASCULAR_SANITIZE STREQUAL "address")
    set(SANITIZERS address,undefined,float-cast-overflow)
    add_compile_options(-fno-sanitize-recover=all
      -fsanitize-ignorelist=${CMAKE_CURRENT_SOURCE_DIR}/test/sanitize/ignored_by_undefined.txt)
    add_compile_definitions(_GLIBCXX_ASSERTIONS)
    # Coverage of all sources would slow the tests down.
    file(GLOB PARSERS CONFIGURE_DEPENDS src/common/xml/*.cpp src/vessel/io/*.cpp src/vessel/anatomy/anatomy_reader.cpp src/scene/*.cpp
      src/yaml/*.cpp src/scene/schema/*.cpp src/haptics/rosserial/*.cpp src/haptics/serial/*.cpp
      src/haptics/host/*.cpp src/drive/*_command.cpp src/drive/command_file.cpp src/haptics/device/*.cpp src/simulation/*archive*.cpp src/nodes/conversions/*.cpp
      src/nodes/session/session_bag.cpp)
    set_source_files_properties(${PARSERS} PROPERTIES COMPILE_OPTIONS -fsanitize=fuzzer-no-link)
  elseif(ENDOVASCULAR_SANITIZE STREQUAL "thread")
    set(SANITIZERS thread)
  else()
    message(FATAL_ERROR "ENDOVASCULAR_SANITIZE is '${ENDOVASCULAR_SANITIZE}': use OFF, address or thread")
  endif()
  add_compile_definitions(ENDOVASCULAR_SANITIZED)
  add_compile_options(-fsanitize=${SANITIZERS} -g1 -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${SANITIZERS})
endif()
