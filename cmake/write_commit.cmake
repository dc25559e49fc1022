# Writes the commit of the sources into a header, and only when it has changed.
#   cmake -DSOURCE=<repository> -DHEADER=<file> -P write_commit.cmake
execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --abbrev=12 --exclude=*
  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
  set(commit "unknown")
endif()
set(text "#define ENDOVASCULAR_SIM_COMMIT \"${commit}\"\n")
set(previous "")
if(EXISTS ${HEADER})
  file(READ ${HEADER} previous)
endif()
if(NOT previous STREQUAL text)
  file(WRITE ${HEADER} "${text}")
endif()
