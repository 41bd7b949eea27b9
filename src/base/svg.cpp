#include "base/svg.h"

#include <fmt/format.h>

#include "base/markup.h"

namespace dihaptic {

Svg::Svg(double width, double height)
    : out_(fmt::format(
          "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {1:g}\" width=\"{0:g}\" "
          "height=\"{1:g}\" font-family=\"sans-serif\" font-size=\"13\">\n"
          "<rect width=\"{0:g}\" height=\"{1:g}\" fill=\"#ffffff\"/>\n",
          width, height)) {}

void Svg::rectangle(double x, double y, double width, double height, const std::string& fill,
                    const std::string& more, const std::string& tip) {
    out_ +=
        fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:g}\" height=\"{:g}\" fill=\"{}\" {}",
                    x, y, width, height, fill, more);
    out_ += tip.empty() ? "/>\n" : fmt::format("><title>{}</title></rect>\n", escaped_markup(tip));
}

void Svg::path(const std::string& d, const char* stroke, double width, const char* fill,
               const std::string& more) {
    out_ += fmt::format(
        "<path d=\"{}\" stroke=\"{}\" stroke-width=\"{:g}\" fill=\"{}\" "
        "stroke-linejoin=\"round\" stroke-linecap=\"round\" {}/>\n",
        d, stroke, width, fill, more);
}

void Svg::text(double x, double y, const std::string& words, const char* anchor,
               const std::string& more) {
    out_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" {}>{}</text>\n", x, y,
                        anchor, more, escaped_markup(words));
}

}  // namespace dihaptic
