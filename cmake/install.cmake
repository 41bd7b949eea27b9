# The contents of an installation: `cmake --install build/release --prefix FOLDER`, and the Debian packages
# (`./dev package`). src/base/installed.h finds these folders from the program's own.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
# The umask determines the permissions of folders, regardless of those given to CMake.
install(CODE [[
    execute_process(COMMAND sh -c umask OUTPUT_VARIABLE mask OUTPUT_STRIP_TRAILING_WHITESPACE)
    if(NOT mask MATCHES "[02][02]$")
        message(WARNING "The umask is ${mask}: nobody else can enter the folders that are made now. If others are to use this "
            "installation, remove it, and install it again after `umask 022`.")
    endif()
]])
set(companions dihaptic-host)
foreach(companion dihaptic-decompose dihaptic-gui dihaptic-mesh)
    if(TARGET ${companion})
        list(APPEND companions ${companion})
    endif()
endforeach()
install(TARGETS dihaptic)
install(TARGETS ${companions} RUNTIME DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/dihaptic)
install(DIRECTORY experiments forms meshes movements octave populations rigs scenes studies textures
    ${PROJECT_BINARY_DIR}/schema
    DESTINATION ${CMAKE_INSTALL_DATADIR}/dihaptic)

# Debian's Python looks there
set(python_folder lib/python3/dist-packages/dihaptic)
install(DIRECTORY python/dihaptic/ DESTINATION ${python_folder} FILES_MATCHING PATTERN *.py PATTERN *.pyi PATTERN py.typed
    PATTERN *.css PATTERN *.js PATTERN __pycache__ EXCLUDE)
if(TARGET dihaptic_python)
    install(TARGETS dihaptic_python LIBRARY DESTINATION ${python_folder})
    foreach(folder ${python_folder} ${CMAKE_INSTALL_DATADIR}/dihaptic/octave)
        install(FILES $<TARGET_FILE_DIR:dihaptic_python>/facts.json DESTINATION ${folder})
    endforeach()
endif()

# The world and its contact solvers for other C++ programs: find_package(dihaptic), dihaptic::dynamics
set(rooms base model contact scene frame dynamics)
set(cmake_folder ${CMAKE_INSTALL_LIBDIR}/cmake/dihaptic)
foreach(room flags ${rooms})
    set_target_properties(dihaptic_${room} PROPERTIES EXPORT_NAME ${room})
    install(TARGETS dihaptic_${room} EXPORT dihaptic INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/dihaptic)
endforeach()
foreach(room ${rooms})
    get_target_property(doors dihaptic_${room} DIHAPTIC_DOORS)
    get_target_property(folder dihaptic_${room} DIHAPTIC_FOLDER)
    foreach(door ${doors})
        cmake_path(GET door PARENT_PATH subfolder)
        install(FILES ${folder}/${door} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/dihaptic/${room}/${subfolder})
    endforeach()
endforeach()
install(EXPORT dihaptic NAMESPACE dihaptic:: FILE targets.cmake DESTINATION ${cmake_folder})
install(FILES cmake/dihaptic-config.cmake DESTINATION ${cmake_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/dihaptic-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/dihaptic-config-version.cmake DESTINATION ${cmake_folder})

# all of the above, without the tests
add_custom_target(installed DEPENDS dihaptic ${companions})
foreach(room ${rooms})
    add_dependencies(installed dihaptic_${room})
endforeach()
if(TARGET dihaptic_python)
    add_dependencies(installed dihaptic_python)
endif()
