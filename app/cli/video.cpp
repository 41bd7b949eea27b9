#include <fmt/format.h>

#include "base/plural.h"
#include "common/output_file.h"
#include "showing.h"
#include "view/movie.h"

namespace dihaptic::cli {
namespace {

constexpr int kRate = 60;  // pictures per second

void make_video(const ViewOptions& options) {
    app::check_output_file(options.out, options.file, "the file shown", ".mp4");
    const Showing showing = open_showing(options.file);
    Drawer drawer(showing, options);
    view::Movie movie(options.out, drawer.width(), drawer.height(), kRate);
    int64_t pictures = 0;
    {
        ProgressLine line("drawing");
        frame::Frame shown;
        while (const frame::Frame* frame = showing.next()) {
            // each picture shows the newest frame at its time; in a gap of the log, the picture is
            // repeated
            while (!shown.bodies.empty() &&
                   seconds(frame->time) > static_cast<double>(pictures) / kRate + 1e-9) {
                movie.add(drawer.draw(shown));
                ++pictures;
                const double shown_for = static_cast<double>(pictures) / kRate;
                line.show_or_stop(showing.duration > 0 ? std::min(1.0, shown_for / showing.duration)
                                                       : 0);
            }
            shown = *frame;
            drawer.follow(shown);
        }
        if (shown.bodies.empty())
            throw Error({options.file, 0}, "", "has no frame", "Give another session.");
        movie.add(drawer.draw(shown));
        ++pictures;
        movie.finish();
    }
    fmt::print("{}: {}, {:.2f} s, {}\n", options.out, showing.title,
               static_cast<double>(pictures) / kRate, counted(pictures, "picture"));
}

}  // namespace

void add_video(CLI::App& app) {
    auto* command =
        app.add_subcommand("video", "Make a video of a session, a scene or an experiment");
    auto options = std::make_shared<ViewOptions>();
    options->out = "session.mp4";
    command->add_option("FILE", options->file, "folder of a session, scene, or experiment")
        ->transform(given_or_kept())
        ->required();
    add_view_options(*command, options);
    command->add_option("-o,--out", options->out, "the video, an MP4 file")->capture_default_str();
    command->footer(
        "\nThe video runs at the session's speed. This command requires the Debian package "
        "ffmpeg.\n\nExample:\n  "
        "dihaptic video sessions/2026-11-20_101500_lift-block --show forces -o lift.mp4");
    command->callback([options] { make_video(*options); });
}

}  // namespace dihaptic::cli
