# Sources in batches: one compilation of several files, so that the headers that they share are read once.
#
# batch(TARGET VARIABLE SIZE): replaces the sources of TARGET, the list in VARIABLE, by files of SIZE sources each. CMake's UNITY_BUILD
# would do, if no two tests had a helper of the same name: here every source keeps its own anonymous namespace. A source with
# definitions outside of it is compiled alone. Messages of the compiler name the lines of the sources.
function(batch target variable size)
  set(result)
  set(remaining)
  foreach(source ${${variable}})
    file(READ ${source} text)
    if(text MATCHES "\n}  // namespace\n\n*[^}\n]" OR NOT text MATCHES "\nnamespace\n{\n")
      list(APPEND result ${source})
    else()
      list(APPEND remaining ${source})
    endif()
  endforeach()
  set(number 0)
  while(remaining)
    list(SUBLIST remaining 0 ${size} sources)
    list(REMOVE_ITEM remaining ${sources})
    set(file ${CMAKE_CURRENT_BINARY_DIR}/batches/${target}_${number}.cpp)
    add_custom_command(OUTPUT ${file}
      COMMAND ${CMAKE_COMMAND} "-DBATCH=${file}" "-DSOURCES=${sources}" -P ${CMAKE_CURRENT_SOURCE_DIR}/cmake/write_batch.cmake
      DEPENDS ${sources} ${CMAKE_CURRENT_SOURCE_DIR}/cmake/write_batch.cmake COMMENT "Generating ${target}_${number}.cpp" VERBATIM)
    list(APPEND result ${file})
    math(EXPR number "${number} + 1")
  endwhile()
  set(${variable} ${result} PARENT_SCOPE)
endfunction()
