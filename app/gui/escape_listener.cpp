#include "escape_listener.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <xcb/xinput.h>

#include <QGuiApplication>
#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <vector>

namespace dihaptic::gui {
namespace {

struct Free {
    void operator()(void* reply) const { std::free(reply); }
};
template <class Reply>
using Answer = std::unique_ptr<Reply, Free>;

/// A connection to the X server that receives every key press ("raw events" of XInput 2.1),
/// whichever window has the keyboard focus, and even while a menu grabs the keyboard.
class Keyboard {
  public:
    Keyboard() : x_(xcb_connect(nullptr, nullptr)) {
        if (xcb_connection_has_error(x_) != 0) return;
        const auto* const extension = xcb_get_extension_data(x_, &xcb_input_id);
        if (extension == nullptr || extension->present == 0) return;
        const Answer<xcb_input_xi_query_version_reply_t> version(
            xcb_input_xi_query_version_reply(x_, xcb_input_xi_query_version(x_, 2, 2), nullptr));
        if (!version || version->major_version < 2 || version->minor_version < 1) return;
        opcode_ = extension->major_opcode;
        find_escape();

        struct {
            xcb_input_event_mask_t head{XCB_INPUT_DEVICE_ALL_MASTER, 1};
            uint32_t mask = XCB_INPUT_XI_EVENT_MASK_RAW_KEY_PRESS;
        } wanted;
        xcb_input_xi_select_events(x_, xcb_setup_roots_iterator(xcb_get_setup(x_)).data->root, 1,
                                   &wanted.head);
        xcb_flush(x_);
    }
    ~Keyboard() { xcb_disconnect(x_); }
    Keyboard(const Keyboard&) = delete;
    Keyboard& operator=(const Keyboard&) = delete;

    bool usable() const { return opcode_ != 0 && xcb_connection_has_error(x_) == 0; }
    int file() const { return xcb_get_file_descriptor(x_); }

    /// Whether Escape was pressed since the last call.
    bool take_escape() {
        bool pressed = false;
        while (const Answer<xcb_generic_event_t> event{xcb_poll_for_event(x_)}) {
            if ((event->response_type & 0x7f) != XCB_GE_GENERIC) continue;
            const auto& press = reinterpret_cast<const xcb_input_raw_key_press_event_t&>(*event);
            pressed |= press.extension == opcode_ && press.event_type == XCB_INPUT_RAW_KEY_PRESS &&
                       std::ranges::count(escapes_, press.detail) > 0;
        }
        return pressed;
    }

  private:
    /// Watches all keys, because any key may have been mapped to Escape.
    void find_escape() {
        constexpr xcb_keysym_t kEscape = 0xff1b;
        const xcb_setup_t& setup = *xcb_get_setup(x_);
        const auto first = setup.min_keycode;
        const auto count = static_cast<uint8_t>(setup.max_keycode - first + 1);
        const Answer<xcb_get_keyboard_mapping_reply_t> keys(xcb_get_keyboard_mapping_reply(
            x_, xcb_get_keyboard_mapping(x_, first, count), nullptr));
        if (!keys) return;
        for (unsigned i = 0; i < count; ++i)
            if (xcb_get_keyboard_mapping_keysyms(keys.get())[i * keys->keysyms_per_keycode] ==
                kEscape)
                escapes_.push_back(first + i);
    }

    xcb_connection_t* x_;
    uint8_t opcode_ = 0;  // opcode of XInput; 0 if it is not available
    std::vector<uint32_t> escapes_;
};

}  // namespace

EscapeListener::EscapeListener() {
    if (QGuiApplication::platformName() != "xcb") return;
    active_ = QGuiApplication::applicationState() == Qt::ApplicationActive;
    connect(qApp, &QGuiApplication::applicationStateChanged, this,
            [this](Qt::ApplicationState now) { active_ = now == Qt::ApplicationActive; });
    quit_ = Descriptor(eventfd(0, EFD_CLOEXEC));
    if (!quit_) return;
    thread_ = std::thread([this] { listen(); });
}

EscapeListener::~EscapeListener() {
    if (!thread_.joinable()) return;
    eventfd_write(quit_.get(), 1);
    thread_.join();
}

void EscapeListener::listen() {
    Keyboard keyboard;
    std::array<pollfd, 2> files{pollfd{keyboard.file(), POLLIN, 0}, pollfd{quit_.get(), POLLIN, 0}};
    while (keyboard.usable()) {
        if (keyboard.take_escape() && active_) Q_EMIT heard();
        poll(files.data(), files.size(), -1);
        if (files[1].revents != 0) return;
    }
}

}  // namespace dihaptic::gui
