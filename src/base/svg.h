// Draws pictures of lines and words as SVG text.
#pragma once

#include <string>

namespace dihaptic {

class Svg {
  public:
    /// Starts an empty picture with a white background and this size [px].
    Svg(double width, double height);

    void rectangle(double x, double y, double width, double height, const std::string& fill,
                   const std::string& more = "", const std::string& tip = "");
    /// Adds an SVG path; `fill` may be "none".
    void path(const std::string& d, const char* stroke, double width, const char* fill = "none",
              const std::string& more = "");
    /// Adds text; `anchor` is "start", "middle" or "end".
    void text(double x, double y, const std::string& words, const char* anchor = "start",
              const std::string& more = "");
    std::string take() { return out_ + "</svg>\n"; }

  private:
    std::string out_;
};

}  // namespace dihaptic
