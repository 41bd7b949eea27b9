#include "rig/workspace.h"

#include <fmt/format.h>

#include "base/text_file.h"
#include "command.h"
#include "common/output_file.h"

namespace dihaptic::cli {
namespace {

std::string in_mm(const Vec3& v) {
    return fmt::format("[{:.0f}, {:.0f}, {:.0f}]", v.x() * 1e3, v.y() * 1e3, v.z() * 1e3);
}

/// Prints the proposed origin and wall in the form used in a rig file.
void print_placement(const rig::Rig& rig, const rig::Workspace& found) {
    const rig::Placement proposed = rig::propose_placement(found);
    fmt::print(
        "\nfor the rig file, to put the world's origin {:.0f} mm over the middle of the box's "
        "floor, and a wall\naround the box, in place of those around each device's "
        "reach:\n\norigin_mm: {}\nwall: {{ centre_mm: {}, size_mm: {} }}\n\n",
        rig::kUnderTable * 1e3, in_mm(proposed.origin + rig.moved_by),
        in_mm(proposed.wall.centre + rig.moved_by), in_mm(proposed.wall.size));
}

/// Prints the share of the rig's wall that is out of reach, because devices may have been moved
/// since the wall was set.
void check_wall(const rig::Rig& rig, const std::vector<rig::Reach>& reaches) {
    if (!rig.wall) return;
    const double out = rig::out_of_reach(rig.wall->box(), reaches);
    fmt::print("  its wall, {} mm around {}, keeps hands where ", in_mm(rig.wall->size),
               in_mm(rig.wall->centre));
    if (out == 0) {
        fmt::print("all devices reach\n");
        return;
    }
    fmt::print("not all devices reach, in {:.1f} % of it\n", out * 100);
    exit_code = kFailed;
}

void show_workspace(const std::string& file, const std::string& out) {
    Diagnostics diagnostics;
    const rig::Rig rig = rig::read_rig(file, diagnostics, rig::NamedBy::the_operator);
    diagnostics.throw_if_errors();
    print(diagnostics.problems());
    app::check_output_file(out, file, "the rig file", ".svg");
    const std::vector<rig::Reach> reaches = rig::reaches(rig);
    rig::Workspace found;
    {
        ProgressLine line("workspace");
        found = rig::find_workspace(reaches, [&](double share) { line.show_or_stop(share); });
    }
    write_file(rig::workspace_picture(found, reaches, rig.title), out);
    fmt::print("{}\n", rig.title);
    for (size_t i = 0; i < reaches.size(); ++i)
        fmt::print("  {:10} reaches {:8.2f} litres\n", reaches[i].finger(), found.volumes[i] * 1e3);
    fmt::print("  {:10} {:16.2f} litres\n", "shared", found.shared * 1e3);
    if (found.shared > 0) {
        const Vec3 size = found.box.sizes() * 1e3;
        const Vec3 middle = found.box.center() * 1e3;
        if (found.box.isEmpty()) {
            fmt::print("  That is too thin for a box: move the devices nearer to each other.\n");
            exit_code = kFailed;
        } else {
            fmt::print(
                "  largest box in it     {:.0f} x {:.0f} x {:.0f} mm around [{:.0f}, {:.0f}, "
                "{:.0f}]\n",
                size.x(), size.y(), size.z(), middle.x(), middle.y(), middle.z());
        }
        const Vec3 centre = found.sphere_centre * 1e3;
        fmt::print("  largest sphere in it  radius {:.0f} mm around [{:.0f}, {:.0f}, {:.0f}]\n",
                   found.sphere_radius * 1e3, centre.x(), centre.y(), centre.z());
        check_wall(rig, reaches);
        if (!found.box.isEmpty()) print_placement(rig, found);
    } else {
        fmt::print("  The devices have no common workspace: move them in the rig file.\n");
        exit_code = kFailed;
    }
    fmt::print("picture: {}\n", out);
}

}  // namespace

void add_workspace(CLI::App& app) {
    auto* command = app.add_subcommand(
        "workspace",
        "The workspaces of a rig's devices, individually and in common, with a picture");
    auto file = std::make_shared<std::string>();
    auto out = std::make_shared<std::string>("workspace.svg");
    command->add_option("RIG", *file, "rig file")->transform(given_or_kept())->required();
    command->add_option("-o,--out", *out, "the picture from above, an SVG file")
        ->capture_default_str();
    command->footer("\nExample:\n  dihaptic workspace rigs/premium-arms.yaml -o workspace.svg");
    command->callback([file, out] { show_workspace(*file, *out); });
}

}  // namespace dihaptic::cli
