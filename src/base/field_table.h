// Lists configuration structs (base/field.h) as a table: each field's full name with its unit, its
// value, and where the value came from.
#pragma once

#include "base/field_reader.h"
#include "base/field_writer.h"
#include "base/table.h"

namespace dihaptic {

class FieldLister {
  public:
    FieldLister(Table& table, const Origins& origins, std::string path = "")
        : table_(table), origins_(origins), path_(std::move(path)) {}

    template <class Struct>
    requires Described<Struct, FieldLister>
    void operator()(std::string_view name, Struct& value, Field = {}) {
        FieldLister inner(table_, origins_, join(name));
        value.visit(inner);
    }
    template <class T>
    void operator()(std::string_view name, const T& value, Field field = {}) {
        FieldWriter writer;
        writer(name, value, field);
        const Node written = writer.take();
        const std::string key =
            written.entries.empty() ? si_key(name, field.quantity) : written.entries.front().key;
        const auto origin = origins_.find(join(name));
        table_.rows.push_back({(path_.empty() ? "" : path_ + ".") + key,
                               written.entries.empty() ? "" : written.entries.front().value.scalar,
                               origin == origins_.end() ? "default" : origin->second});
    }

  private:
    std::string join(std::string_view name) const {
        return path_.empty() ? std::string(name) : path_ + "." + std::string(name);
    }
    Table& table_;
    const Origins& origins_;
    std::string path_;
};

template <class Struct>
Table list_fields(Struct value, const Origins& origins) {
    Table table;
    table.columns = {{"setting", "name and unit"},
                     {"value", "as used"},
                     {"origin", "where the value was given: file and line, or default"}};
    FieldLister lister(table, origins);
    value.visit(lister);
    return table;
}

}  // namespace dihaptic
