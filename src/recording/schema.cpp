#include "recording/schema.h"

#include "frame/frame.h"

namespace dihaptic::recording {
namespace {

/// Lists the fields of a Frame, visiting one item of each list.
class Lister {
  public:
    template <class T>
    void operator()(const T&, const frame::Term& term) {
        text_ += prefix_ + schema_line<T>(term) + "\n";
    }
    template <class T>
    void each(const char* name, const std::vector<T>&, const char*) {
        item<T>(schema_line(name, false));
    }
    template <class T>
    void changed(const char* name, const std::vector<T>&, const std::vector<uint16_t>&,
                 const char*) {
        item<T>(schema_line(name, true));
    }
    std::string take() { return std::move(text_); }

  private:
    template <class T>
    void item(const std::string& line) {
        text_ += line + "\n";
        prefix_ = "  ";
        const T value{};
        T::visit(value, *this);
        prefix_.clear();
    }
    std::string text_;
    std::string prefix_;
};

}  // namespace

std::string schema() {
    Lister lister;
    const frame::Frame frame;
    frame::Frame::visit(frame, lister);
    return lister.take();
}

}  // namespace dihaptic::recording
