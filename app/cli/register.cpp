#include <fmt/format.h>

#include <Eigen/Geometry>

#include "base/text_file.h"
#include "base/unit.h"
#include "command.h"
#include "common/output_file.h"
#include "recording/session.h"
#include "rig/registration_run.h"
#include "terminal_guide.h"

namespace dihaptic::cli {
namespace {

struct RegisterOptions {
    std::string rig;
    std::string display;
    std::string finger;
    std::string crosses;
    std::string out;
};

/// The screen at the pose at which a simulated finger touches it: displaced from the pose in the
/// file, so that the command has a result to show.
display::Display misplaced(const display::Display& display) {
    display::Display out = display;
    const Vec3 about = display.at({0.5, 0.5});
    const Quat R(Eigen::AngleAxisd(2 * kDegree, display.up().normalized()));
    for (Vec3* corner : {&out.lower_left, &out.lower_right, &out.upper_left})
        *corner = about + R * (*corner - about) + Vec3(3e-3, 0, 4e-3);
    return out;
}

void draw_crosses(const display::Display& display, const RegisterOptions& options) {
    app::check_output_file(options.crosses, options.rig, "the rig file", ".svg");
    write_file(display::cross_picture(display), options.crosses);
    fmt::print("{}: show it on the whole of {}'s screen, then register without --crosses\n",
               options.crosses, display.name);
}

void register_display(const RegisterOptions& options) {
    Diagnostics diagnostics;
    const rig::Rig rig =
        rig::read_rig_to_register(options.rig, diagnostics, rig::NamedBy::the_operator);
    diagnostics.throw_if_errors();
    print(diagnostics.problems());
    const display::Display& display = rig::display_of(rig, options.display);
    if (!options.crosses.empty()) return draw_crosses(display, options);
    const std::string finger =
        options.finger.empty() ? rig::held_fingers(rig).front() : options.finger;
    const std::string out =
        options.out.empty() ? rig::registration_file(display, options.rig) : options.out;
    check_output(out, options.rig, "the rig file");
    std::vector<Vec3> touches;
    try {
        TerminalGuide guide("register");
        touches = rig::lead_registration(rig, finger, misplaced(display), guide.guide());
    } catch (const rig::GivenUp&) {
        fmt::print(stderr, "interrupted: nothing was stored\n");
        exit_code = kFailed;
        return;
    }
    display::RegistrationResult result = display::register_screen(display, touches);
    result.registration.date = recording::iso_now().substr(0, 10);
    rig::store_registration(rig, result.registration, out);
    fmt::print("{}, {}\n{}registration: {}\n", rig.title, display.name, display::describe(result),
               out);
    if (!rig::is_real(rig))
        fmt::print("Simulated: the finger touched a screen that is 5 mm and 2 degrees off.\n");
    if (display.registration.empty())
        fmt::print("\nfor the rig file, under {}:\n\n    {}\n", display.name,
                   rig::registration_line(options.rig, out));
}

}  // namespace

void add_register(CLI::App& app) {
    auto* command = app.add_subcommand("register",
                                       "Find the position at which the person sees a rig's "
                                       "display, by touching crosses with a finger");
    auto options = std::make_shared<RegisterOptions>();
    command->add_option("RIG", options->rig, "rig file that defines the display")
        ->transform(given_or_kept())
        ->required();
    command->add_option("--display", options->display,
                        "name of the display; default: the rig's only one");
    command->add_option("--finger", options->finger,
                        "finger that touches; default: that of the rig's first device");
    command->add_option("--crosses", options->crosses,
                        "only draw the crosses, to this SVG file, which any program may show on "
                        "the whole screen");
    command->add_option("-o,--out", options->out,
                        "registration file; default: the display's own, next to the rig file");
    command->footer(
        "\nExamples:\n  dihaptic register rigs/mirror-rig.yaml --crosses crosses.svg\n"
        "  dihaptic register rigs/mirror-rig.yaml -o registration.yaml");
    command->callback([options] { register_display(*options); });
}

}  // namespace dihaptic::cli
