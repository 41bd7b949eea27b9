// Generates JSON Schemas, draft 7, from configuration structs (base/field.h). An editor that has
// the schema of a file can complete and explain the keys, and mark mistakes as they are typed.
//
// A schema accepts everything that FieldReader accepts. It is meant for YAML 1.2, in which yes and
// no are words. Mistakes that a schema cannot detect are left to `dihaptic check`: names of objects
// that do not exist, mistakes in expressions, and keys that exclude each other.
#pragma once

#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <typeindex>
#include <vector>

#include "base/field.h"
#include "base/field_writer.h"
#include "base/formula.h"
#include "base/geometry.h"
#include "base/kinds.h"
#include "base/node.h"

namespace dihaptic {

/// A schema or a part of a schema. Its keys keep their order.
using Json = nlohmann::ordered_json;

/// The keys that a mapping may have.
struct SchemaKeys {
    struct Key {
        std::string name;
        Json schema;
    };
    std::vector<Key> keys;
    /// For each required key: its name combined with each possible unit.
    std::vector<std::vector<std::string>> required;
};

/// The schema of one kind of file. Each struct is defined once, and keys refer to that definition.
class JsonSchema {
  public:
    /// Describes a part of the file that is read elsewhere (a Node with this name in a visit()),
    /// using the keys of a struct or a schema. Must be called before of(). A Node without a
    /// description may be any mapping.
    template <class Struct>
    void part(const std::string& name, const std::string& heading, const Struct& value) {
        part_of_kind(name, "", heading, value);
    }
    void part(const std::string& name, const Json& schema) {
        parts_[{name, ""}] = [schema] { return schema; };
    }
    /// Like the function above, for a mapping of the kind `word` (kinds_of()).
    template <class Struct>
    void part_of_kind(const std::string& name, const std::string& word, const std::string& heading,
                      const Struct& value) {
        parts_[{name, word}] = [this, heading, value] {
            const Json ref = refer(value, heading);
            // a mapping may be left empty
            definitions_[heading]["type"] = Json::array({"object", "null"});
            return ref;
        };
    }

    /// The schema of a file that is read into this struct. `heading` names the kind of file in one
    /// or two words.
    template <class Struct>
    Json of(const Struct& value, const std::string& heading) {
        return whole(object(value, heading), heading);
    }

    /// The schema of a value that is yes or no.
    static Json yes_or_no() { return {{"enum", {"yes", "no", true, false, "true", "false"}}}; }
    /// The schema of any word or text, including a number, "yes" or "true".
    static Json word();

  private:
    friend class SchemaLister;

    Json whole(const Json& keys, const std::string& heading) const;
    /// The schema of a mapping with these keys.
    static Json mapping(const SchemaKeys& keys);
    /// The schema of a mapping whose keys depend on the value of `key`.
    static Json mapping(std::string_view key, const std::vector<std::string_view>& words,
                        const std::vector<SchemaKeys>& each);
    /// The keys of a mapping that can be written in two ways.
    static SchemaKeys either(SchemaKeys one, const SchemaKeys& other);

    template <class Struct>
    SchemaKeys keys_of(const Struct& value, const std::string& path, std::string_view word = "");
    template <class Struct>
    Json object(const Struct& value, const std::string& path) {
        if constexpr (HasKinds<Struct>) {
            const Kinds<Struct> kinds = kinds_of(value);
            std::vector<std::string_view> words;
            std::vector<SchemaKeys> each;
            for (const auto& [word, one] : kinds.each) {
                words.push_back(word);
                each.push_back(keys_of(one, path, word));
            }
            return mapping(kinds.key, words, each);
        } else {
            return mapping(keys_of(value, path));
        }
    }
    /// A reference to the definition of the struct. The definition is named after the first key
    /// that uses it.
    template <class Struct>
    Json refer(const Struct& value, const std::string& path) {
        const auto [name, is_new] = names_.try_emplace(typeid(Struct), path);
        const std::string at = name->second;
        if (is_new) definitions_[at] = object(value, at);
        return reference(at);
    }
    static Json reference(const std::string& definition);
    Json part_of(const std::string& name, std::string_view word) const;

    std::map<std::pair<std::string, std::string>, std::function<Json()>>
        parts_;  // indexed by name and kind
    std::map<std::type_index, std::string> names_;
    Json definitions_ = Json::object();
};

/// Visitor that lists the keys of one struct.
class SchemaLister {
  public:
    /// `word` is the kind of the struct, if it has kinds. If `as_lists`, a value that may be either
    /// a list or a mapping is described as a list.
    SchemaLister(JsonSchema& schema, std::string path, std::string_view word, bool as_lists)
        : schema_(schema), path_(std::move(path)), word_(word), as_lists_(as_lists) {}

    template <class T>
    void operator()(std::string_view name, T& value, Field field = {}) {
        FieldWriter writer;
        writer(name, value, field);
        add(name, field, writer.take(),
            [&](double si) { return of(value, field, si, std::string(name)); });
    }
    bool is_list(std::string_view) {
        asked_ = true;
        return as_lists_;
    }

    bool asked() const { return asked_; }
    SchemaKeys take() { return std::move(found_); }

  private:
    /// Adds a key; `written` holds the key with or without its default.
    void add(std::string_view name, const Field& field, const Node& written,
             const std::function<Json(double si)>& schema);
    static Json one_of(std::vector<std::string> words);
    static Json list_of(Json items);
    void keep_one_default(size_t units, const Json& best);

    /// The schema of a value; `si` is the value of the key's unit in SI units.
    static Json of(double, const Field& field, double si, const std::string&);
    static Json of(const Vec3&, const Field& field, double si, const std::string&);
    static Json of(const Mat3&, const Field& field, double si, const std::string&);
    static Json of(const Formula&, const Field& field, double si, const std::string&);
    static Json of(const FormulaVec3&, const Field& field, double si, const std::string&);
    static Json of(const std::vector<double>&, const Field& field, double si, const std::string&);
    static Json of(int, const Field& field, double, const std::string&);
    static Json of(bool, const Field&, double, const std::string&);
    static Json of(const std::string&, const Field& field, double, const std::string&);
    static Json of(const std::vector<std::string>&, const Field& field, double, const std::string&);
    static Json of(const Texts&, const Field& field, double, const std::string&);
    Json of(const Node&, const Field&, double, const std::string& name) const {
        return schema_.part_of(name, word_);
    }
    template <NamedEnum E>
    static Json of(const E& value, const Field&, double, const std::string&) {
        const auto names = enum_names(value);
        return one_of({names.begin(), names.end()});
    }
    template <class Struct>
    requires Described<Struct, SchemaLister> Json of(const Struct& value, const Field&, double,
                                                     const std::string& name) {
        return schema_.refer(value, path_ + "." + name);
    }
    template <class Struct>
    requires Described<Struct, SchemaLister> Json of(const std::vector<Struct>&, const Field&,
                                                     double, const std::string& name) {
        return list_of(schema_.refer(Struct{}, path_ + "." + name));
    }
    template <class T>
    Json of(const std::optional<T>& value, const Field& field, double si, const std::string& name) {
        static const T kNone{};
        return of(value ? *value : kNone, field, si, name);
    }

    JsonSchema& schema_;
    std::string path_;
    std::string_view word_;
    bool as_lists_;
    bool asked_ = false;
    SchemaKeys found_;
};

template <class Struct>
SchemaKeys JsonSchema::keys_of(const Struct& value, const std::string& path,
                               std::string_view word) {
    const auto list = [&](bool as_lists) {
        Struct one = value;
        SchemaLister lister(*this, path, word, as_lists);
        one.visit(lister);
        return std::pair(lister.asked(), lister.take());
    };
    auto [asked, keys] = list(false);
    return asked ? either(std::move(keys), list(true).second) : keys;
}

}  // namespace dihaptic
