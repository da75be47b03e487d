#pragma once

#include <string>

namespace terra::advisor {

/// Answers a question of WritePrompt in a model's stead, from nothing but the
/// text and the first picture: reads the colours back into terrain, searches
/// the cheapest way there and thins it to few waypoints. Says `Yes` where the
/// baseline named in the text is as good as that.
///
/// What it sees is what a model sees: cells under a marker are guessed from
/// their surroundings, and a reduced picture gives a coarse answer, which may
/// be invalid on the real map. A question that it cannot read is answered with
/// a sentence that says so (an attempt without a route).
/// Shows that the way from map to advice works; nothing about any model.
std::string SimulatedAnswer(const std::string& text, const std::string& png);

}  // namespace terra::advisor
