# Embeds the text of files in the program, so that it is available wherever the program runs. Writes the source FILE,
# which defines in NAMESPACE what HEADER declares: for each NAME=PATH a std::string_view of that name with the file's
# text.
#
#   dihaptic_embed(${CMAKE_CURRENT_BINARY_DIR}/texts.cpp room/texts.h dihaptic::room kText=${PROJECT_SOURCE_DIR}/text.yaml)
function(dihaptic_embed file header namespace)
    set(source "#include \"${header}\"\n\nnamespace ${namespace} {\n")
    foreach(entry ${ARGN})
        string(REGEX MATCH "^[^=]+" name ${entry})
        string(REGEX REPLACE "^[^=]+=" "" path ${entry})
        set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${path})
        file(READ ${path} content)
        string(APPEND source "const std::string_view ${name} = R\"~~~(${content})~~~\";\n")
    endforeach()
    string(APPEND source "}  // namespace ${namespace}\n")
    file(CONFIGURE OUTPUT ${file} CONTENT "${source}" @ONLY)
endfunction()
