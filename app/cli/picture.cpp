#include <fmt/format.h>

#include "common/output_file.h"
#include "showing.h"

namespace dihaptic::cli {
namespace {

struct PictureOptions : ViewOptions {
    std::optional<double> time;
};

void make_picture(const PictureOptions& options) {
    app::check_output_file(options.out, options.file, "the file shown", ".png");
    const Showing showing = open_showing(options.file);
    Drawer drawer(showing, options);
    // a scene is shown at its start, a session at its end
    const double time =
        options.time.value_or(showing.recorded ? std::numeric_limits<double>::infinity() : 0);
    frame::Frame shown;
    double end = -1;
    {
        ProgressLine line("reading");
        const double all = std::max(std::min(time, showing.duration), 1e-3);
        int64_t count = 0;
        while (const frame::Frame* frame = showing.next()) {
            end = seconds(frame->time);
            // `shown` is already the newest frame at that time
            if (end > time + 1e-9 && count > 0) break;
            shown = *frame;
            drawer.follow(shown);
            if (++count % 2000 == 0) line.show_or_stop(std::min(1.0, end / all));
        }
    }
    if (end < 0) throw Error({options.file, 0}, "", "has no frame", "Give another session.");
    if (options.time && end < *options.time - 1e-9)
        throw Error({"--time", 0}, "",
                    fmt::format("{:g} s is beyond the end, which is at {:g} s", *options.time, end),
                    fmt::format("Give a time from 0 to {:g}.", end));
    write_png(drawer.draw(shown), options.out);
    fmt::print("{}: {} at {:.3f} s\n", options.out, showing.title, seconds(shown.time));
}

}  // namespace

void add_picture(CLI::App& app) {
    auto* command = app.add_subcommand(
        "picture", "Draw a scene, an experiment or a recorded session, without a window");
    auto options = std::make_shared<PictureOptions>();
    options->out = "scene.png";
    command->add_option("FILE", options->file, "scene, experiment, or folder of a session")
        ->transform(given_or_kept())
        ->required();
    command
        ->add_option("--time", options->time,
                     "moment to show [s]; default: a scene's start, a session's end")
        ->check(CLI::NonNegativeNumber);
    add_view_options(*command, options);
    command->add_option("-o,--out", options->out, "the picture, a PNG file")->capture_default_str();
    command->footer(
        "\nExamples:\n"
        "  dihaptic picture scenes/tools.yaml -o tools.png\n"
        "  dihaptic picture sessions/2026-11-20_101500_lift-block --time 5 --camera side --show "
        "path,forces -o lift.png");
    command->callback([options] { make_picture(*options); });
}

}  // namespace dihaptic::cli
