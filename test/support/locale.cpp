// Tests use the system language's format of numbers, as the window's toolkit does: no number may
// depend on it (base/number.h). LC_ALL=de_DE.UTF-8 ./dev test --fast tries another language.
#include <clocale>

namespace {

[[maybe_unused]] const char* const taken = std::setlocale(LC_NUMERIC, "");

}  // namespace
