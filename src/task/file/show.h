// What an experiment file says of what a person sees: what a state hides, how things look, and the
// pages before a block (docs/files.md).
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/field_reader.h"
#include "scene/scene.h"
#include "task/file/ref.h"
#include "task/file/region.h"

namespace dihaptic::task {

/// The fingers' proxies. `held`: they are shown where they were when the state began.
enum class Cursor { yes, no, held };
constexpr auto enum_names(Cursor) {
    return std::array{"yes", "no", "held"};
}

/// What is shown while a state lasts; in the file a mapping, or the list of targets alone.
struct Show {
    std::vector<std::string> targets;  ///< regions
    Cursor cursor = Cursor::yes;
    bool object = true;  ///< the scene's
    Node bodies;         ///< name: yes or no
    Node fingers;        ///< name: yes or no; in place of what `cursor` says
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("targets", targets, says("Regions that are shown."));
        v("cursor", cursor,
          says("Whether the fingers' proxies are shown, or shown where they were as "
               "the state began."));
        v("object", object, says("Whether the scene's object is shown."));
        v("bodies", bodies, says("Single bodies by name, each shown or not."));
        v("fingers", fingers,
          says("Single fingers by name, each shown or not, in place of what cursor says."));
        if constexpr (requires { v.place(); }) place = v.place();
    }
    /// As visit(), for the one key of a struct that has it.
    template <class Visitor>
    void visit_in(Visitor& v) {
        bool is_list = cursor == Cursor::yes && object && bodies.kind == Node::Kind::null &&
                       fingers.kind == Node::Kind::null;
        if constexpr (requires { v.is_list("show"); }) is_list = v.is_list("show");
        if (is_list) {
            v("show", targets);
        } else {
            v("show", *this,
              says("What is shown while the state lasts, or the list of targets alone."));
        }
    }
};

/// How one thing looks: a body, a finger's proxy, or a target.
struct LookSpec {
    Ref<scene::Body> body;
    Ref<scene::Finger> finger;
    Ref<Region> target;
    std::string colour;  ///< "#rrggbb"; empty: as it is
    double scale = 1;    ///< factor on the displayed size
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("body", body, says("Body that looks so."));
        v("finger", finger, says("Finger whose proxy looks so."));
        v("target", target, says("Region that looks so."));
        v("colour", colour, says("Its colour, as \"#rrggbb\"."));
        v("scale", scale, Field::number().within(0.05, 20).says("Factor on its displayed size."));
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

/// A page that is shown in place of the scene until a key is pressed, or for a time.
struct PageSpec {
    std::string text;      ///< Markdown
    std::string picture;   ///< PNG file, relative to the experiment file
    std::string checksum;  ///< of the picture, once it was found (base/checksum.h)
    std::string key;       ///< one letter or digit; empty: any
    double lasts = 0;      ///< longest time for which it is shown; 0: until the key [s]
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("text", text, says("Text of the page, in Markdown; numbers stand in braces."));
        v("picture", picture, says("PNG file, relative to this file."));
        v("key", key, says("Letter or digit that turns the page; left out, any."));
        v("for", lasts,
          Field::of(Quantity::time)
              .within(0, 3600)
              .says("Longest time for which the page is shown; 0 is until the key."));
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

}  // namespace dihaptic::task
