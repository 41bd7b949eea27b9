// The visual part of an experiment file: objects that a state hides, the looks of objects, and the
// pages shown before a block (docs/files.md).
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/field_reader.h"
#include "scene/scene.h"
#include "task/file/ref.h"
#include "task/file/region.h"

namespace dihaptic::task {

struct State;

/// How the fingers' proxies are displayed. With `held`, they stay where they were displayed when
/// the state began, or when the state `held_from` last ended.
enum class Cursor { yes, no, held };
constexpr auto enum_names(Cursor) {
    return std::array{"yes", "no", "held"};
}

/// The objects shown while a state lasts. In the file, this is a mapping or just the list of
/// targets.
struct Show {
    std::vector<std::string> targets;  ///< regions that are shown
    Cursor cursor = Cursor::yes;
    std::string held_from;  ///< state at whose end the cursor is held; if empty, the previous state
    bool object = true;     ///< whether the scene's object is shown
    Node bodies;            ///< for each body name, yes or no
    Node fingers;           ///< for each finger name, yes or no; overrides `cursor`
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("targets", targets, says("Regions that are shown."));
        v("cursor", cursor,
          says("Whether the fingers' proxies are shown; with 'held', at their positions when the "
               "state began, or when the state 'held_from' ended."));
        v("held_from", held_from,
          says("With 'cursor: held', the state whose end determines where the fingers' proxies are "
               "shown; the previous state if omitted."));
        v("object", object, says("Whether the scene's object is shown."));
        v("bodies", bodies, says("Individual bodies by name, each shown or not."));
        v("fingers", fingers,
          says("Individual fingers by name, each shown or not; overrides 'cursor'."));
    }
    /// Visits the key `show` of a struct that contains a Show.
    template <class Visitor>
    void visit_in(Visitor& v) {
        bool is_list = cursor == Cursor::yes && held_from.empty() && object &&
                       bodies.kind == Node::Kind::null && fingers.kind == Node::Kind::null;
        if constexpr (requires { v.is_list("show"); }) is_list = v.is_list("show");
        if (is_list) {
            v("show", targets);
        } else {
            v("show", *this,
              says("Objects shown while the state lasts, or just the list of targets."));
        }
    }
};

/// The look of a body, a finger's proxy, or a target.
struct LookSpec {
    Ref<scene::Body> body;
    Ref<scene::Finger> finger;
    Ref<Region> target;
    std::string colour;  ///< "#rrggbb"; if empty, the colour is unchanged
    double scale = 1;    ///< factor on the displayed size
    bool hidden = false;
    Refs<State> during;  ///< states in which a condition's look applies; if empty, all states
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("body", body, says("Body that gets this look."));
        v("finger", finger, says("Finger whose proxy gets this look."));
        v("target", target, says("Region that gets this look."));
        v("colour", colour, says("Colour, as \"#rrggbb\"."));
        v("scale", scale, Field::number().within(0.05, 20).says("Factor on the displayed size."));
        v("hidden", hidden, says("Whether the object is hidden."));
        v("during", during, says("States in which a condition's look applies; all if omitted."));
    }
};

/// A page that is shown in place of the scene until a key is pressed or a time has passed.
struct PageSpec {
    std::string text;      ///< text of the page, in Markdown
    std::string picture;   ///< PNG or GIF file, relative to the experiment file
    std::string checksum;  ///< checksum of the picture, once the file is found (base/checksum.h)
    std::string key;       ///< letter or digit that ends the page; if empty, any key does
    double lasts = 0;  ///< longest time for which the page is shown; if 0, until the key press [s]
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("text", text,
          says("Text of the page, in Markdown; names in braces are replaced with numbers."));
        v("picture", picture,
          says("PNG or GIF file, which may be animated; its path is relative to this file."));
        v("key", key, says("Letter or digit that turns the page; any key if omitted."));
        v("for", lasts,
          Field::of(Quantity::time)
              .within(0, 3600)
              .says("Longest time for which the page is shown; 0: until the key is pressed."));
    }
};

}  // namespace dihaptic::task
