# Read by ctest, for each program of GoogleTest (dihaptic_suites() in rooms.cmake): each of its suites becomes a test
# ROOM/SUITE. Most cases last for less time than a process takes to start.
#
# `room`, `program`, `folder`: the room, its program of tests, and the folder in which that is started. `properties`: of
# each test.

if(NOT EXISTS ${program})
    add_test(${room}/not_built ${program})
    return()
endif()
execute_process(COMMAND ${program} --gtest_list_tests WORKING_DIRECTORY ${folder} OUTPUT_VARIABLE listed
    RESULT_VARIABLE failed)
if(failed)
    message(FATAL_ERROR "${program} --gtest_list_tests: ${failed}")
endif()
string(REGEX REPLACE ";" "," listed "${listed}")
string(REGEX MATCHALL "(^|\n)[A-Za-z][^ \n]*\\." suites "${listed}")
foreach(suite ${suites})
    string(REGEX REPLACE "\n|\\.$" "" suite ${suite})
    add_test(${room}/${suite} ${program} --gtest_filter=${suite}.*)
    set_tests_properties(${room}/${suite} PROPERTIES WORKING_DIRECTORY ${folder} ${properties})
endforeach()
