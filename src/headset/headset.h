// Shows the scene in a headset, through whichever OpenXR runtime the system has, in a thread of its
// own at the headset's own rate. README.md lists the tests and headsets tried.
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "base/latest.h"
#include "display/headset.h"
#include "frame/frame.h"
#include "scene/scene.h"

namespace dihaptic::headset {

/// A picture that was handed to the headset.
struct Showing {
    int64_t tick = 0;  ///< tick of the frame that it shows
    /// Time when its light appears, as predicted by the runtime; without a prediction, when the
    /// picture was submitted.
    std::chrono::steady_clock::time_point at;
    Pose X_WV;  ///< pose of the head then: V is between the eyes, x right, y up, z backward
    bool tracked = false;  ///< whether X_WV was measured, not guessed
};

/// Drawn texts, which hang where the head was looking when they appeared.
struct Words {
    static constexpr int kWidth = 1200, kHeight = 900;  // [pixels]
    /// Red, green, blue and opacity of each pixel, rows from top to bottom; empty: no words.
    std::vector<uint8_t> rgba;
};

/// A message about an event.
struct Note {
    std::string text;
    bool problem = false;
};

class Headset {
  public:
    using Frames = Latest<frame::Frame>;

    /// Starts showing; if this fails, a Note reports it.
    explicit Headset(const display::Headset& place);
    ~Headset();
    Headset(const Headset&) = delete;
    Headset& operator=(const Headset&) = delete;

    /// From now on shows the newest of these frames, which belong to that scene. The headset's
    /// thread is their reader. A frame with a negative `sequence` belongs to no tick, and produces
    /// no Showing.
    void show(const scene::Scene& scene, std::shared_ptr<Frames> frames);
    void set_words(Words words);

    /// The pictures since the last call, up to a minute of them.
    std::vector<Showing> take_showings();
    /// The events since the last call.
    std::vector<Note> take_notes();
    /// Whether the headset has stopped showing; a Note gives the reason.
    bool ended() const { return ended_; }

  private:
    /// The content to be shown.
    struct Content {
        std::shared_ptr<const scene::Scene> scene;  // null: nothing yet
        std::shared_ptr<Frames> frames;
        std::shared_ptr<const Words> words;
    };
    void run();
    void show_until_done();
    void note(const std::string& text, bool problem);
    Content content();

    display::Headset place_;
    std::mutex guard_;  // guards the members below
    Content content_;
    std::vector<Showing> showings_;
    std::vector<Note> notes_;

    std::atomic<bool> done_{false};
    std::atomic<bool> ended_{false};
    std::thread thread_;
};

}  // namespace dihaptic::headset
