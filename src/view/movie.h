// Makes videos with the program ffmpeg, which receives each picture as soon as it is drawn.
#pragma once

#include <string>

#include "base/image.h"
#include "base/output.h"

namespace dihaptic::view {

/// An MP4 file (H.264) under construction. It appears under its name once it is complete.
class Movie {
  public:
    /// Throws Error when ffmpeg is missing, or when width or height is odd, because players refuse
    /// odd sizes.
    Movie(const std::string& file, int width, int height, int frames_per_second);
    /// Leaves no file unless finish() was called.
    ~Movie();
    Movie(const Movie&) = delete;
    Movie& operator=(const Movie&) = delete;

    /// Throws an Error with ffmpeg's message when ffmpeg has ended prematurely.
    void add(const Image& image);
    void finish();

  private:
    int wait();
    [[noreturn]] void fail();

    std::string file_;
    Output output_;
    int pictures_ = -1;  // socket from which ffmpeg reads pictures
    int said_ = -1;      // memory file to which ffmpeg writes its errors
    int process_ = -1;
};

}  // namespace dihaptic::view
