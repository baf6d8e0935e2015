// A node that does not watch strokes (node_features.hpp): its dictionary has none of their objects,
// so none of this is asked for.

#include "firmware/node/node.hpp"

namespace volcomp::node {

using canopen::AbortCode;

bool Node::learns_for(std::size_t /*axis*/) const { return false; }
std::int32_t Node::tick_strokes() { return 0; }
void Node::restart_strokes() {}
void Node::stop_strokes() {}
void Node::poll_strokes() {}
AbortCode Node::switch_strokes(StrokeCommand /*command*/) { return AbortCode::none; }
AbortCode Node::learn(LearnCommand /*command*/) { return AbortCode::none; }
void Node::read_strokes(std::uint16_t /*index*/) {}
AbortCode Node::read_stroke_domain(canopen::ObjectId /*object*/,
                                   Span<const std::uint8_t>& /*source*/) {
  return AbortCode::no_data;
}
Span<std::uint8_t> Node::learned_sink() { return {}; }
Span<const std::uint8_t> Node::learned_image() { return {}; }
AbortCode Node::finish_learned(std::size_t /*size*/) { return AbortCode::none; }
void Node::load_strokes(Span<const std::uint8_t> /*image*/) {}

}  // namespace volcomp::node
