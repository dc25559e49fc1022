# Libraries of the core, lowest first: folder of src : layers whose headers it includes, without those that another one
# includes already : libraries from outside. The targets evs_<folder>, the shared core with what it links, the installed
# headers and the test programs follow from this list. test/scripts/test_layers.sh compares it with the includes and with
# the order in docs/ARCHITECTURE.md.
set(LAYERS
  "common        :                                            : Threads::Threads ${CMAKE_DL_LIBS}"
  "yaml          : common                                     : yaml-cpp"
  "geometry      : common                                     :"
  "image         : common                                     :"
  "contact       : geometry                                   : fcl"
  "rod           : contact                                    : ${KLU_LIBRARY} ${CHOLMOD_LIBRARY}"
  "vessel        : geometry yaml                              : ${TINYXML_LIBRARY} ZLIB::ZLIB"
  "contrast      : vessel                                     :"
  "flow          : contrast                                   :"
  "motion        : contact vessel                             :"
  "segmentation  : image vessel                               :"
  "instrument    : rod                                        :"
  "intervention  : instrument vessel                          :"
  "patient       : image vessel                               :"
  "phantom       : patient                                    :"
  "fluoroscopy   : contrast instrument motion patient         : PNG::PNG ${XRAYLIB_LIBRARY}"
  "drive         : common                                     :"
  "robot         : drive                                      :"
  "haptics       : drive                                      :"
  "sensor        : common                                     :"
  "scene         : fluoroscopy robot sensor flow              :"
  "simulation    : intervention scene                         :"
  "procedure     : simulation                                 :"
  "results       : procedure                                  :"
  "session       : results                                    :"
  "visualization : geometry                                   :")

# Parts of a layer's folder that are libraries of their own, because they link what few programs need.
set(SEPARATE_FOLDERS vessel/prepare segmentation/mesh image/import robot/urdf)

# The calls in these take most of the time of steps, frames and images.
set(FAST_LAYERS geometry rod contact contrast motion patient phantom fluoroscopy segmentation)

# read_layer(LINE): sets `layer`, `layer_includes` and `layer_links`.
macro(read_layer line)
  string(REGEX MATCH "^([a-z]+) *:([^:]*):(.*)$" layer_line "${line}")
  if(NOT layer_line)
    message(FATAL_ERROR "cmake/layers.cmake: '${line}' is not 'folder : layers : libraries'")
  endif()
  set(layer ${CMAKE_MATCH_1})
  set(layer_links "${CMAKE_MATCH_3}")
  string(REGEX MATCHALL "[^ ]+" layer_includes "${CMAKE_MATCH_2}")
  string(REGEX MATCHALL "[^ ]+" layer_links "${layer_links}")
endmacro()
