# What another project can link after `cmake --install`: the message types, the
# ground truth, the verifier and the receiver of a udpm:// bus, as
# TerraAdvisor::terra_msg, ::terra_terrain, ::terra_verifier and ::terra_udpm of
# find_package(TerraAdvisor).
include(CMakePackageConfigHelpers)
set(package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/TerraAdvisor")

install(TARGETS terra_msg terra_terrain terra_verifier terra_udpm
        EXPORT TerraAdvisorTargets)
install(EXPORT TerraAdvisorTargets NAMESPACE TerraAdvisor::
        DESTINATION "${package_dir}")
foreach(folder IN ITEMS terrain verifier)
  file(GLOB headers "${PROJECT_SOURCE_DIR}/${folder}/*.h")
  list(FILTER headers EXCLUDE REGEX "_node\\.h$")
  install(FILES ${headers}
          DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/terra_advisor/${folder}")
endforeach()

install(FILES "${PROJECT_SOURCE_DIR}/bus/lcm_url.h"
              "${PROJECT_SOURCE_DIR}/bus/udpm_receiver.h"
        DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/terra_advisor/bus")

get_filename_component(LCM_PREFIX "${LCM_INCLUDE_DIR}" DIRECTORY)
configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/TerraAdvisorConfig.cmake.in"
  "${CMAKE_CURRENT_BINARY_DIR}/TerraAdvisorConfig.cmake"
  INSTALL_DESTINATION "${package_dir}")
write_basic_package_version_file("${CMAKE_CURRENT_BINARY_DIR}/TerraAdvisorConfigVersion.cmake"
  COMPATIBILITY SameMinorVersion)
install(FILES "${CMAKE_CURRENT_BINARY_DIR}/TerraAdvisorConfig.cmake"
              "${CMAKE_CURRENT_BINARY_DIR}/TerraAdvisorConfigVersion.cmake"
              "${PROJECT_SOURCE_DIR}/cmake/FindLCM.cmake"
              "${PROJECT_SOURCE_DIR}/cmake/TerraFindLibrary.cmake"
        DESTINATION "${package_dir}")

# The executables of the running set, and the target that builds them with all
# else that is installed: after it, `cmake --install` works.
set(executables)
foreach(name IN ITEMS terra terra-map terra-planner terra-graph-planner
                      terra-advisor terra-verifier terra-logger terra-llm-sim
                      terra-chaos)
  if(TARGET ${name})
    list(APPEND executables ${name})
  endif()
endforeach()
add_custom_target(terra_stack)
add_dependencies(terra_stack terra_msg_headers terra_msg_python terra_terrain
                 terra_verifier terra_udpm)
if(TERRA_BUILD_JAVA)
  add_dependencies(terra_stack terra_msg_jar)
endif()
if(executables)
  add_dependencies(terra_stack ${executables})
  install(TARGETS ${executables})
endif()
