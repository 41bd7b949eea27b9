// Videos, by the program ffmpeg: pictures go to it as they are drawn.
#pragma once

#include <string>

#include "view/image.h"

namespace dihaptic::view {

/// An MP4 file (H.264) in the making. It appears under its name once it is whole.
class Movie {
  public:
    /// Throws Error when ffmpeg is missing, or when width or height is odd, which players refuse.
    Movie(const std::string& file, int width, int height, int frames_per_second);
    /// Without finish() nothing is left.
    ~Movie();
    Movie(const Movie&) = delete;
    Movie& operator=(const Movie&) = delete;

    /// Throws Error when ffmpeg ended before its time, with what it said.
    void add(const Image& image);
    void finish();

  private:
    int wait();
    [[noreturn]] void fail();

    std::string file_;
    std::string part_;
    int pictures_ = -1;  // what ffmpeg reads
    int said_ = -1;      // what it writes when something is wrong
    int process_ = -1;
};

}  // namespace dihaptic::view
