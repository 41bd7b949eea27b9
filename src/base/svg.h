// Draws pictures of lines and words as SVG text.
#pragma once

#include <string>

namespace dihaptic {

class Svg {
  public:
    /// An empty picture on a white background [px].
    Svg(double width, double height);

    void rectangle(double x, double y, double width, double height, const std::string& fill,
                   const std::string& more = "", const std::string& tip = "");
    /// An SVG path; `fill` may be "none".
    void path(const std::string& d, const char* stroke, double width, const char* fill = "none",
              const std::string& more = "");
    /// `anchor`: start, middle, end.
    void text(double x, double y, const std::string& words, const char* anchor = "start",
              const std::string& more = "");
    std::string take() { return out_ + "</svg>\n"; }

  private:
    std::string out_;
};

}  // namespace dihaptic
