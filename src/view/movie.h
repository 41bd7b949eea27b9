// Makes videos with the program ffmpeg, to which each picture is passed as soon as it is drawn.
#pragma once

#include <string>

#include "base/child.h"
#include "base/descriptor.h"
#include "base/image.h"
#include "base/output.h"

namespace dihaptic::view {

/// An MP4 file (H.264) that is being written. It gets its final name only when it is complete.
class Movie {
  public:
    /// Throws Error when ffmpeg is missing, or when `width` or `height` is odd, because video
    /// players refuse odd sizes.
    Movie(const std::string& file, int width, int height, int frames_per_second);

    /// Adds a picture. If ffmpeg has ended prematurely, throws an Error with ffmpeg's message.
    void add(const Image& image);
    /// Completes the file. If finish() is not called, no file remains.
    void finish();

  private:
    int wait();
    [[noreturn]] void fail();

    std::string file_;
    Output output_;
    Descriptor pictures_;  // socket from which ffmpeg reads the pictures
    Descriptor said_;      // memory file to which ffmpeg writes its errors
    Child ffmpeg_;         // declared last, so that ffmpeg ends before the file is removed
};

}  // namespace dihaptic::view
