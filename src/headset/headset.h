// Shows the scene in a headset, using whichever OpenXR runtime the system has. Runs in its own
// thread, at the headset's own rate. README.md lists the tests, and the headsets that were tried.
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
    /// Time at which the picture's light appears, as predicted by the runtime; if there is no
    /// prediction, the time at which the picture was submitted.
    std::chrono::steady_clock::time_point at;
    Pose X_WV;  ///< pose of the head then: V is between the eyes, x right, y up, z backward
    bool tracked = false;  ///< whether X_WV was measured rather than guessed
};

/// Drawn texts. They hang in the place where the head was looking when they appeared.
struct Words {
    static constexpr int kWidth = 1200, kHeight = 900;  // [pixels]
    /// Red, green, blue and opacity of each pixel, in rows from top to bottom; empty if there are
    /// no words.
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

    /// Starts showing the scene. If that fails, a Note reports it.
    explicit Headset(const display::Headset& place);
    ~Headset();
    Headset(const Headset&) = delete;
    Headset& operator=(const Headset&) = delete;

    /// From now on, shows the newest of these frames, which belong to the given scene. Only the
    /// headset's thread reads them. A frame with a negative `sequence` belongs to no tick and
    /// produces no Showing.
    void show(const scene::Scene& scene, std::shared_ptr<Frames> frames);
    void set_words(Words words);

    /// Returns the pictures shown since the last call, covering at most one minute.
    std::vector<Showing> take_showings();
    /// Returns the events since the last call.
    std::vector<Note> take_notes();
    /// Whether the headset has stopped showing the scene; a Note gives the reason.
    bool ended() const { return ended_; }

  private:
    /// What is to be shown.
    struct Content {
        std::shared_ptr<const scene::Scene> scene;  // null if there is nothing to show yet
        std::shared_ptr<Frames> frames;
        std::shared_ptr<const Words> words;
    };
    void run();
    void show_until_done();
    void note(const std::string& text, bool problem);
    Content content();

    display::Headset place_;
    std::mutex guard_;  // protects the members below
    Content content_;
    std::vector<Showing> showings_;
    std::vector<Note> notes_;

    std::atomic<bool> done_{false};
    std::atomic<bool> ended_{false};
    std::thread thread_;
};

}  // namespace dihaptic::headset
