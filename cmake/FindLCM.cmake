# LCM as Debian ships it has no CMake package, and its pkg-config file asks for
# GLib headers that nothing here needs. Defines LCM::lcm and LCM_GEN.
find_path(LCM_INCLUDE_DIR lcm/lcm.h)
find_library(LCM_LIBRARY lcm)
find_program(LCM_GEN lcm-gen)
get_filename_component(lcm_programs "${LCM_GEN}" DIRECTORY)
find_file(LCM_JAR lcm.jar HINTS "${lcm_programs}/../share/java"
          PATHS /usr/share/java /usr/local/share/java)
mark_as_advanced(LCM_INCLUDE_DIR LCM_LIBRARY LCM_GEN LCM_JAR)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(LCM
  REQUIRED_VARS LCM_LIBRARY LCM_INCLUDE_DIR LCM_GEN)

if(LCM_FOUND AND NOT TARGET LCM::lcm)
  add_library(LCM::lcm UNKNOWN IMPORTED)
  set_target_properties(LCM::lcm PROPERTIES
    IMPORTED_LOCATION "${LCM_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${LCM_INCLUDE_DIR}"
    INTERFACE_SYSTEM_INCLUDE_DIRECTORIES "${LCM_INCLUDE_DIR}")
endif()
