#pragma once

#include <string>

#include "terrain/legend.h"
#include "terrain/result.h"

namespace terra {

/// Returns the built-in legend of that name, else reads it as a CSV file:
/// header `id,name,cost,color`, cost a number or `inf`, colour `#RRGGBB`.
/// Errors: name the file and line, or the built-in names.
Result<Legend> ReadLegend(const std::string& name_or_path);

/// Writes that CSV form; ReadLegend gives back an equal legend.
Status WriteLegend(const Legend& legend, const std::string& path);

}  // namespace terra
