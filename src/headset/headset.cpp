#include "headset/headset.h"

#include <array>

#include "base/diagnostics.h"
#include "headset/eyes.h"
#include "view/scene_view.h"

namespace dihaptic::headset {
namespace {

constexpr auto kIdle = std::chrono::milliseconds(10);  // time between two polls of the runtime
constexpr size_t kMostShowings = 6000;

/// Draws both eyes side by side in one pass, so that the shadows have to be computed only once.
class Drawing {
  public:
    Drawing(int width, int height) : width_(width), height_(height) {
        glGenFramebuffers(1, &framebuffer_);
        glGenRenderbuffers(1, &colour_);
        glBindRenderbuffer(GL_RENDERBUFFER, colour_);
        glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, 2 * width, height);
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour_);
    }
    ~Drawing() {
        glDeleteFramebuffers(1, &framebuffer_);
        glDeleteRenderbuffers(1, &colour_);
    }
    Drawing(const Drawing&) = delete;
    Drawing& operator=(const Drawing&) = delete;

    void set_scene(const std::shared_ptr<const scene::Scene>& scene) {
        if (scene == scene_) return;
        scene_ = scene;
        view_ = std::make_unique<view::SceneView>(*scene);
    }

    void draw(const frame::Frame& frame, Eyes& eyes, const Eyes::Look& look) {
        std::array<view::Pane, Eyes::kCount> panes{view::Pane{look.eyes[0]},
                                                   view::Pane{look.eyes[1]}};
        panes[0].width = panes[1].width = panes[1].left = 0.5;
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_);
        view_->draw(frame, panes, 2 * width_, height_);
        for (size_t eye = 0; eye < Eyes::kCount; ++eye) {
            glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
            eyes.copy_from(eye, static_cast<int>(eye) * width_);
        }
    }

  private:
    int width_, height_;
    GLuint framebuffer_ = 0, colour_ = 0;
    std::shared_ptr<const scene::Scene> scene_;
    std::unique_ptr<view::SceneView> view_;
};

}  // namespace

Headset::Headset(const display::Headset& place) : place_(place), thread_([this] { run(); }) {}

Headset::~Headset() {
    done_ = true;
    thread_.join();
}

void Headset::show(const scene::Scene& scene, std::shared_ptr<Frames> frames) {
    auto copy = std::make_shared<const scene::Scene>(scene);
    const std::lock_guard lock(guard_);
    content_.scene = std::move(copy);
    content_.frames = std::move(frames);
}

void Headset::set_words(Words words) {
    auto copy = std::make_shared<const Words>(std::move(words));
    const std::lock_guard lock(guard_);
    content_.words = std::move(copy);
}

std::vector<Showing> Headset::take_showings() {
    const std::lock_guard lock(guard_);
    return std::exchange(showings_, {});
}

std::vector<Note> Headset::take_notes() {
    const std::lock_guard lock(guard_);
    return std::exchange(notes_, {});
}

void Headset::note(const std::string& text, bool problem) {
    const std::lock_guard lock(guard_);
    notes_.push_back({text, problem});
}

Headset::Content Headset::content() {
    const std::lock_guard lock(guard_);
    return content_;
}

void Headset::run() {
    try {
        show_until_done();
    } catch (const std::exception& e) {
        note(e.what(), true);
    }
    ended_ = true;
}

void Headset::show_until_done() {
    const GlxContext gl;
    Eyes eyes(place_, gl);
    note(eyes.describe(), false);
    if (view::is_software(view::renderer()))
        note("there is no graphics card: the headset's pictures are late", true);
    Drawing drawing(eyes.width(), eyes.height());
    std::shared_ptr<const Words> words;
    while (!done_) {
        if (!eyes.wants_pictures()) {
            std::this_thread::sleep_for(kIdle);
            continue;
        }
        Eyes::Look look = eyes.begin_picture();
        const Content now = content();
        const frame::Frame* const frame = now.frames ? &now.frames->read() : nullptr;
        look.drawn = look.drawn && frame != nullptr;
        Showing showing{-1, {}, {}, false};
        if (look.drawn) {
            drawing.set_scene(now.scene);
            drawing.draw(*frame, eyes, look);
            if (now.words && now.words != words) eyes.set_words(*(words = now.words), look);
            showing = {frame->sequence, {}, look.X_WV, look.tracked};
        }
        showing.at = eyes.end_picture(look);
        if (showing.tick < 0) continue;
        const std::lock_guard lock(guard_);
        if (showings_.size() < kMostShowings) showings_.push_back(showing);
    }
}

}  // namespace dihaptic::headset
