# Without ROS: folders of the build and of the installation as catkin would lay them out, and a CMake package of the core.
set(PREFIX_OF_BUILD ${CMAKE_CURRENT_BINARY_DIR})
set(CATKIN_PACKAGE_BIN_DESTINATION lib/${PROJECT_NAME})
set(CATKIN_PACKAGE_INCLUDE_DESTINATION include/${PROJECT_NAME})
set(CATKIN_PACKAGE_LIB_DESTINATION lib)
set(CATKIN_PACKAGE_SHARE_DESTINATION share/${PROJECT_NAME})
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PREFIX_OF_BUILD}/lib/${PROJECT_NAME})
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY ${PREFIX_OF_BUILD}/lib)

include(CMakePackageConfigHelpers)
set(package_files ${PREFIX_OF_BUILD}/share/${PROJECT_NAME}/cmake)
configure_file(cmake/endovascular_sim-extras.cmake.in ${package_files}/${PROJECT_NAME}Config.cmake @ONLY)
write_basic_package_version_file(${package_files}/${PROJECT_NAME}Config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${package_files}/${PROJECT_NAME}Config.cmake ${package_files}/${PROJECT_NAME}Config-version.cmake
  DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION}/cmake)
