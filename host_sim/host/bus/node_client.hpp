#pragma once
// Objects of the compensation node read and written one by one, as a service tool does: every call
// returns with the answer.

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "firmware/canopen/nmt.hpp"
#include "firmware/node/object_handles.hpp"
#include "host_sim/host/bus/links/frame_link.hpp"
#include "host_sim/host/bus/sdo_channel.hpp"

namespace volcomp::host {

// The node refused. The text names the object and the reason.
struct NodeRefused : std::runtime_error {
  NodeRefused(const std::string& text, canopen::AbortCode abort)
      : std::runtime_error(text), code(abort) {}
  canopen::AbortCode code;
};

class NodeClient {
 public:
  // Lets the bus work for about a millisecond: sends what the client offers, hands it what has
  // arrived (canopen/exchange.hpp). Returns the time in µs.
  using Pump = std::function<std::uint64_t(NodeClient&)>;
  using Progress = std::function<void(std::size_t bytes)>;

  // node_id 1…127.
  NodeClient(std::uint8_t node_id, Pump pump);

  // For each answer.
  void set_timeout_us(std::uint64_t timeout_us) { channel_.set_timeout_us(timeout_us); }

  // All throw NodeRefused, or UserError when the node does not answer, or answers nonsense.
  // `most`: bytes the value may have; `what` names it in messages.
  [[nodiscard]] SdoChannel::Bytes read(canopen::ObjectId object, std::size_t most,
                                       const std::string& what);
  void write(canopen::ObjectId object, SdoChannel::Bytes value, const std::string& what,
             const Progress& progress = {});

  // By its handle (object_handles.hpp), perhaps as another type.
  template <class T>
  [[nodiscard]] auto read(const canopen::object_lines::Handle<T>& object) {
    return value_of<T>(read(object.id(), object.bytes(), object.name));
  }
  template <class As, class T>
  [[nodiscard]] As read(const canopen::object_lines::Handle<T>& object) {
    return static_cast<As>(read(object));
  }
  // Nothing where the node does not know the object.
  template <class T>
  [[nodiscard]] std::optional<T> find(const canopen::object_lines::Handle<T>& object) {
    try {
      return read(object);
    } catch (const NodeRefused& refused) {
      if (refused.code == canopen::AbortCode::no_object) return std::nullopt;
      throw;
    }
  }
  // All values of it.
  template <class T, std::size_t count>
  void read(const canopen::object_lines::Handle<T>& object, std::array<T, count>& values) {
    for (std::size_t i = 0; i < count; ++i)
      values[i] = read(object[i]);
  }

  // Lets the bus work for so long.
  void let_pass(std::uint64_t time_us);

  // The state in the next heartbeat; nothing when none comes in time.
  [[nodiscard]] std::optional<canopen::NmtState> await_heartbeat(std::uint64_t timeout_us);

  [[nodiscard]] std::uint8_t node_id() const { return node_id_; }

  // --- the loop of canopen/exchange.hpp
  void receive(const hal::CanFrame& frame, std::uint64_t now_us);
  void poll(std::uint64_t now_us) { channel_.poll(now_us); }
  [[nodiscard]] bool offer(hal::CanFrame& frame, std::uint64_t /*now_us*/) {
    return channel_.offer(frame);
  }
  void taken(std::uint64_t /*now_us*/) { channel_.taken(); }

 private:
  void finish_transfer(const Progress& progress);
  [[noreturn]] void fail();

  std::uint8_t node_id_;
  Pump pump_;
  SdoChannel channel_;
  bool answered_ = false;  // ever
  std::optional<canopen::NmtState> heartbeat_;
};

// A pump over a link. Throws what the link throws.
class LinkPump {
 public:
  explicit LinkPump(std::shared_ptr<FrameLink> link) : link_(std::move(link)) {}
  std::uint64_t operator()(NodeClient& client) const;

 private:
  std::shared_ptr<FrameLink> link_;  // a Pump is copied
};

}  // namespace volcomp::host
