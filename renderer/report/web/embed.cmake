# Writes a C++ source in which text files stand as string constants:
#   cmake -DOUTPUT=FILE.cpp -DNAMES=page_css;chart_js -DFILES=page.css;chart.min.js -P embed.cmake
# Each becomes `extern const std::string_view NAME` in namespace midway::web. Raw literals hold any
# text but their own end, which is looked for.
set(text "#include <string_view>\n\nnamespace midway::web {\n")
foreach(name file IN ZIP_LISTS NAMES FILES)
    file(READ "${file}" content)
    string(FIND "${content}" ")midway_web\"" end)
    if(NOT end EQUAL -1)
        message(FATAL_ERROR "cannot embed: the text holds the end of a literal (${file}); change it")
    endif()
    string(APPEND text "extern const std::string_view ${name};\n"
        "const std::string_view ${name} = R\"midway_web(${content})midway_web\";\n")
endforeach()
string(APPEND text "}  // namespace midway::web\n")
file(WRITE "${OUTPUT}" "${text}")
