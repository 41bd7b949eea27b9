# The headers of other libraries that nearly every source includes are compiled once for all rooms and the program (by
# dihaptic_base), and once for all tests (by dihaptic_testing), which saves a quarter of the time of a first build.
# Each source nevertheless includes what it needs.
function(dihaptic_precompile target by)
    if(CCACHE)
        return()
    endif()
    if(NOT target STREQUAL by)
        target_precompile_headers(${target} REUSE_FROM ${by})
        return()
    endif()
    target_precompile_headers(${target} PRIVATE ${ARGN} <Eigen/Dense> <fmt/format.h> <algorithm> <atomic>
        <chrono> <filesystem> <fstream> <functional> <map> <memory> <optional> <random> <sstream> <string>
        <thread> <variant> <vector>)
endfunction()

# The sources of a target are compiled as one. A first build then takes a sixth to a fifth less time than ten at a time,
# since much of a compiler's work is to read the same headers and to generate the same code from them. A name in one
# source's unnamed namespace must not mean something else in another source of the target; NAME_test.cpp has a namespace
# NAME_test, and may therefore use any name. For a day of changes to one room,
# cmake --preset release -DCMAKE_UNITY_BUILD_BATCH_SIZE=5 compiles less after each change.
if(NOT DEFINED CMAKE_UNITY_BUILD_BATCH_SIZE)
    set(CMAKE_UNITY_BUILD_BATCH_SIZE 0)
endif()
function(dihaptic_together target)
    if(DEFINED CMAKE_UNITY_BUILD AND NOT CMAKE_UNITY_BUILD)
        return()
    endif()
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON)
    # the Impl to which a class has a pointer may contain types from its source's unnamed namespace
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endfunction()

# A room is a folder of src/: one static library, its headers, its tests, its soaks (`./dev soak`), and
# its fuzzers (fuzz/NAME_fuzz.cpp with NAME_corpus next to it; test/support/fuzz.h).
#
#   dihaptic_room(haptics DOORS proxy.h kinds/*.h USES dynamics LINKS Foo::foo)
#
# DOORS: the headers that other rooms may include, and the room's headers that these include. USES: the rooms that it
# may include. LINKS: external libraries, which stay private. SOURCES: generated files. A room's doors are reached
# through an include folder of their own, so including any other header, or a room that is not named (or used by a named
# one), does not compile: arrows point down only, and end at doors. Tests may look into every room. LEAKY: its tests
# load libraries that leak memory and are unloaded by the end. TEST_LOCK: a resource that only one test of this and
# other rooms may use at a time.
function(dihaptic_room name)
    cmake_parse_arguments(ROOM "LEAKY" "TEST_LOCK" "DOORS;USES;LINKS;SOURCES;TEST_USES" ${ARGN})
    set(folder ${CMAKE_CURRENT_SOURCE_DIR})

    # relative, since the folder that holds the project may itself be called test
    file(GLOB_RECURSE sources RELATIVE ${folder} CONFIGURE_DEPENDS ${folder}/*.cpp)
    list(FILTER sources EXCLUDE REGEX "(^|/)(test|soak|fuzz)/")
    list(TRANSFORM sources PREPEND ${folder}/)
    set(room dihaptic_${name})
    if(sources)
        add_library(${room} STATIC ${sources} ${ROOM_SOURCES})
        dihaptic_together(${room})
        set(scope PUBLIC)
    else()
        add_library(${room} INTERFACE)  # headers only
        set(scope INTERFACE)
    endif()

    set(inside ${PROJECT_BINARY_DIR}/rooms/${name})
    file(MAKE_DIRECTORY ${inside})
    file(CREATE_LINK ${folder} ${inside}/${name} SYMBOLIC)
    set(outside ${PROJECT_BINARY_DIR}/doors/${name})
    file(REMOVE_RECURSE ${outside})
    list(TRANSFORM ROOM_DOORS PREPEND ${folder}/)
    file(GLOB doors RELATIVE ${folder} CONFIGURE_DEPENDS ${ROOM_DOORS})
    foreach(door ${doors})
        get_filename_component(subfolder ${outside}/${name}/${door} DIRECTORY)
        file(MAKE_DIRECTORY ${subfolder})
        file(CREATE_LINK ${folder}/${door} ${outside}/${name}/${door} SYMBOLIC)
    endforeach()
    target_include_directories(${room} INTERFACE $<BUILD_INTERFACE:${outside}>)
    set_target_properties(${room} PROPERTIES DIHAPTIC_DOORS "${doors}" DIHAPTIC_FOLDER ${folder})
    if(sources)
        target_include_directories(${room} PRIVATE ${inside})
    endif()
    list(TRANSFORM ROOM_USES PREPEND dihaptic_)
    target_link_libraries(${room} ${scope} dihaptic_flags ${ROOM_USES})
    if(sources)
        dihaptic_precompile(${room} dihaptic_base)
    endif()
    if(ROOM_LINKS)
        target_link_libraries(${room} PRIVATE ${ROOM_LINKS})
    endif()

    if(NOT "tests" IN_LIST DIHAPTIC_PARTS)
        return()
    endif()
    file(GLOB tests CONFIGURE_DEPENDS ${folder}/test/*_test.cpp ${folder}/*/test/*_test.cpp)
    if(tests)
        add_executable(${name}_test ${tests})
        target_link_libraries(${name}_test PRIVATE ${room} dihaptic_testing ${ROOM_LINKS} ${ROOM_TEST_USES})
        target_include_directories(${name}_test PRIVATE ${inside})
        dihaptic_together(${name}_test)
        dihaptic_precompile(${name}_test dihaptic_testing)
        set(properties "")
        if(ROOM_LEAKY AND DIHAPTIC_SANITIZE)
            list(APPEND properties ENVIRONMENT_MODIFICATION ASAN_OPTIONS=string_append::detect_leaks=0)
        endif()
        if(ROOM_TEST_LOCK)
            list(APPEND properties RESOURCE_LOCK ${ROOM_TEST_LOCK})
        endif()
        dihaptic_suites(${name} ${properties})
    endif()
    file(GLOB soaks CONFIGURE_DEPENDS ${folder}/soak/*_soak.cpp)
    if(DIHAPTIC_SOAKS AND soaks)
        add_executable(${name}_soak ${soaks})
        target_link_libraries(${name}_soak PRIVATE ${room} dihaptic_testing ${ROOM_LINKS} ${ROOM_TEST_USES})
        target_include_directories(${name}_soak PRIVATE ${inside})
        gtest_discover_tests(${name}_soak DISCOVERY_TIMEOUT 60 WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
            PROPERTIES LABELS soak TIMEOUT 7200)
    endif()
    file(GLOB fuzzers CONFIGURE_DEPENDS ${folder}/fuzz/*_fuzz.cpp ${folder}/*/fuzz/*_fuzz.cpp)
    foreach(fuzzer ${fuzzers})
        get_filename_component(target ${fuzzer} NAME_WE)
        string(REGEX REPLACE "_fuzz.cpp$" "_corpus" corpus ${fuzzer})
        add_executable(${target} ${fuzzer})
        target_link_libraries(${target} PRIVATE ${room} ${ROOM_LINKS})
        target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/src)
        if(DIHAPTIC_SANITIZE MATCHES fuzzer)
            target_include_directories(${target} PRIVATE ${PROJECT_BINARY_DIR}/rooms/testing)
            target_link_options(${target} PRIVATE -fsanitize=fuzzer)
            set_target_properties(${target} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/fuzzers)
            add_dependencies(fuzzers ${target})
        else()
            target_link_libraries(${target} PRIVATE dihaptic_feed_corpus)
            dihaptic_precompile(${target} dihaptic_base)
            add_test(NAME ${target} COMMAND ${target} ${corpus} WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
            set_tests_properties(${target} PROPERTIES LABELS ${name} TIMEOUT ${DIHAPTIC_TIMEOUT})
        endif()
    endforeach()
endfunction()

# Each suite of ROOM_test is a test ROOM/SUITE of ctest, with these properties.
function(dihaptic_suites room)
    set(file ${CMAKE_CURRENT_BINARY_DIR}/${room}_suites.cmake)
    file(GENERATE OUTPUT ${file} CONTENT "set(room ${room})
set(program \"$<TARGET_FILE:${room}_test>\")
set(folder \"${PROJECT_SOURCE_DIR}\")
set(properties LABELS ${room} TIMEOUT ${DIHAPTIC_TIMEOUT} ${ARGN})
include(\"${PROJECT_SOURCE_DIR}/cmake/suites.cmake\")
")
    set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${file})
endfunction()

# A file of tests in Python that imports test/soak.py runs a sample in `./dev test`, and everything in `./dev soak`, as
# NAME/soak. Arguments after the file are passed to the test.
function(dihaptic_soak_of name file)
    file(STRINGS ${file} imports REGEX "^(from|import) soak")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
    if(NOT imports)
        return()
    endif()
    add_test(NAME ${name}/soak COMMAND ${SYSTEM_PYTHON} ${file} ${ARGN} WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
    set_tests_properties(${name}/soak PROPERTIES TIMEOUT 7200 LABELS soak ENVIRONMENT DIHAPTIC_SOAK=1
        ENVIRONMENT_MODIFICATION PYTHONPATH=set:${PROJECT_BINARY_DIR}/python)
    if(name MATCHES "^attack/")
        set_tests_properties(${name}/soak PROPERTIES LABELS "soak;attack")
    elseif(name MATCHES "^gui/")
        set_tests_properties(${name}/soak PROPERTIES RUN_SERIAL ON)
    endif()
endfunction()

# The table of a seam's implementations: each subfolder with a header KIND.h has a namespace of the
# folder's name, in NAMESPACE, with a function KIND(); a KIND test/NAME is for tests only, and its function is NAME().
# FILE is made from FILE.in, which contains @includes@ and @entries@. Adding an implementation touches one folder.
#
#   dihaptic_table(device_table.cpp backend dihaptic::devices)
function(dihaptic_table file kind namespace)
    get_filename_component(room ${CMAKE_CURRENT_SOURCE_DIR} NAME)
    get_filename_component(function ${kind} NAME)
    file(GLOB headers RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} CONFIGURE_DEPENDS */${kind}.h)
    set(includes "")
    set(entries "")
    foreach(header ${headers})
        string(REGEX REPLACE "/.*" "" folder ${header})
        string(APPEND includes "#include \"${room}/${header}\"\n")
        string(APPEND entries "    ${namespace}::${folder}::${function}(),\n")
    endforeach()
    configure_file(${file}.in ${file} @ONLY)
endfunction()
