#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "objects/object_pick.h"

namespace terrella {

/// A field of an object, as texts.
struct ObjectField {
  std::string name;
  std::string value;
  bool operator==(const ObjectField&) const = default;
};

/// The name of an object and its other fields.
struct ObjectFields {
  std::string title = {};  ///< empty if no field is a name
  std::vector<ObjectField> rows = {};
};

/// Reads the properties of a feature, a JSON object. Fields without a value are left out, values of more than 1,000
/// bytes are cut, and after 100 rows one row counts the others. Markup of HTML is left out where it is well formed.
/// thread: any
[[nodiscard]] ObjectFields object_fields(std::string_view properties);

/// Returns the value of one field, as object_fields() returns it; empty without a value. thread: any
[[nodiscard]] std::string object_field(std::string_view properties, const std::string& name);

/// Name of a picked object: that of its fields, else its kind, such as "Area". thread: any
[[nodiscard]] std::string object_title(const PickedObject& object, const ObjectFields& fields);

/// True for a whole text that is an address of http or https, in characters that addresses may have. thread: any
[[nodiscard]] bool is_link(std::string_view text);

}  // namespace terrella
