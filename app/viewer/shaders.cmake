# Writes OUTPUT: a C++ file that holds the texts of FILES (absolute paths, separated by |) for
# shader_text() in gl.h.
string(REPLACE "|" ";" files "${FILES}")
set(code "// Written by app/viewer/shaders.cmake from shaders/.\n#include \"viewer/gl.h\"\n\n")
string(APPEND code "namespace midway {\n\nstd::string_view shader_text(std::string_view name) {\n")
foreach(file IN LISTS files)
    get_filename_component(name "${file}" NAME)
    file(READ "${file}" text)
    string(APPEND code "    if (name == \"${name}\")\n        return R\"glsl(${text})glsl\";\n")
endforeach()
string(APPEND code "    return {};\n}\n\n}  // namespace midway\n")
file(WRITE "${OUTPUT}" "${code}")
