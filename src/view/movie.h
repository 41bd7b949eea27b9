// Makes videos with the program ffmpeg, which receives each picture as soon as it is drawn.
#pragma once

#include <string>

#include "base/child.h"
#include "base/descriptor.h"
#include "base/image.h"
#include "base/output.h"

namespace dihaptic::view {

/// An MP4 file (H.264) under construction. It appears under its name once it is complete.
class Movie {
  public:
    /// Throws Error when ffmpeg is missing, or when width or height is odd, because players refuse
    /// odd sizes.
    Movie(const std::string& file, int width, int height, int frames_per_second);

    /// Throws an Error with ffmpeg's message when ffmpeg has ended prematurely.
    void add(const Image& image);
    /// Without this call, no file remains.
    void finish();

  private:
    int wait();
    [[noreturn]] void fail();

    std::string file_;
    Output output_;
    Descriptor pictures_;  // socket from which ffmpeg reads pictures
    Descriptor said_;      // memory file to which ffmpeg writes its errors
    Child ffmpeg_;         // declared last, so that it ends before the file is removed
};

}  // namespace dihaptic::view
