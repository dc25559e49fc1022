# Without ROS: folders of the build and of the installation as catkin lays them out, and a CMake package of the core.
set(PREFIX_OF_BUILD ${CMAKE_CURRENT_BINARY_DIR})
set(PROGRAM_DESTINATION lib/${PROJECT_NAME})
set(HEADER_DESTINATION include/${PROJECT_NAME})
set(LIBRARY_DESTINATION lib)
set(SHARE_DESTINATION share/${PROJECT_NAME})
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PREFIX_OF_BUILD}/lib/${PROJECT_NAME})
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY ${PREFIX_OF_BUILD}/lib)

include(CMakePackageConfigHelpers)
set(PACKAGE_FILES ${PREFIX_OF_BUILD}/share/${PROJECT_NAME}/cmake)
configure_file(cmake/endovascular_sim-extras.cmake.in ${PACKAGE_FILES}/${PROJECT_NAME}Config.cmake @ONLY)
write_basic_package_version_file(${PACKAGE_FILES}/${PROJECT_NAME}Config-version.cmake COMPATIBILITY SameMinorVersion)
#catkin_lint: ignore_once missing_directory
install(DIRECTORY ${PACKAGE_FILES} DESTINATION ${SHARE_DESTINATION} FILES_MATCHING PATTERN "*Config*.cmake")
