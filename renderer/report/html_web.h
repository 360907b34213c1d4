// The texts of renderer/report/web/ and Chart.js as constants of the program (web/embed.cmake).
#pragma once

#include <string_view>

namespace midway::web {

extern const std::string_view page_html, page_css, page_js, charts_js, chart_js;
extern const std::string_view images_html, images_css, images_js, viewer_js;

}  // namespace midway::web
