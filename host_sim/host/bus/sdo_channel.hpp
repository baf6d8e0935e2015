#pragma once
// Reads and writes of one node's objects over SDO, one after the other: what a configuration tool
// or a motion controller keeps per node.

#include <algorithm>
#include <deque>
#include <functional>
#include <string>
#include <type_traits>
#include <vector>

#include "comp/core/bytes.hpp"
#include "firmware/canopen/sdo_client.hpp"
#include "firmware/node/object_handles.hpp"
#include "hal/can_port.hpp"

namespace volcomp::host {

// An unsigned number from the bytes of an object.
[[nodiscard]] inline std::uint64_t number(const std::vector<std::uint8_t>& bytes) {
  return load_le(bytes.data(), bytes.size() < 8 ? bytes.size() : 8);
}

// The value of a Handle<T> from its bytes; text up to its end.
template <class T>
[[nodiscard]] auto value_of(const std::vector<std::uint8_t>& bytes) {
  if constexpr (std::is_same_v<T, char>) {
    return std::string(bytes.begin(), std::find(bytes.begin(), bytes.end(), 0));
  } else if constexpr (std::is_same_v<T, double>) {
    return bit_cast<double>(number(bytes));
  } else if constexpr (std::is_same_v<T, float>) {
    return bit_cast<float>(static_cast<std::uint32_t>(number(bytes)));
  } else {
    return static_cast<T>(number(bytes));
  }
}

// The other way round, two's complement or IEEE 754.
template <class T>
[[nodiscard]] std::uint64_t bits_of(T value) {
  if constexpr (std::is_same_v<T, double>) return bit_cast<std::uint64_t>(value);
  if constexpr (std::is_same_v<T, float>) return bit_cast<std::uint32_t>(value);
  return static_cast<std::uint64_t>(value);
}

class SdoChannel {
 public:
  using Bytes = std::vector<std::uint8_t>;
  using OnRead = std::function<void(const Bytes&)>;
  using OnDone = std::function<void()>;

  explicit SdoChannel(std::uint8_t node) : node_(node) {}

  // For an answer; from the next transfer on.
  void set_timeout_us(std::uint64_t timeout_us) { timeout_us_ = timeout_us; }
  // Queue a transfer. `what` names it in messages.
  void write(canopen::ObjectId object, Bytes value, std::string what, OnDone done = {});
  template <class T>
  void write_value(canopen::ObjectId object, T value, std::string what, OnDone done = {}) {
    Bytes bytes(sizeof(T));
    store_le(bytes.data(), sizeof(T), bits_of(value));
    write(object, std::move(bytes), std::move(what), std::move(done));
  }
  template <class T>
  void write(const canopen::object_lines::Handle<T>& object, std::common_type_t<T> value) {
    write_value<T>(object.id(), value, object.name);
  }
  // `most`: bytes the value may have.
  void read(canopen::ObjectId object, std::size_t most, std::string what, OnRead done);
  // `done` takes the value.
  template <class T, class Done>
  void read(const canopen::object_lines::Handle<T>& object, Done done) {
    read(object.id(), object.bytes(), object.name,
         [done](const Bytes& bytes) { done(value_of<T>(bytes)); });
  }

  // After a failure the rest of the queue is dropped; failure() gives the reason.
  [[nodiscard]] bool idle() const { return jobs_.empty() && !outgoing_; }
  [[nodiscard]] const std::string& failure() const { return failure_; }
  [[nodiscard]] canopen::AbortCode abort_code() const { return abort_code_; }
  // Whether the node refused; otherwise this side did, for a missing or too long answer.
  [[nodiscard]] bool refused() const { return refused_; }
  // The object of the last failed transfer.
  [[nodiscard]] canopen::ObjectId failed() const { return failed_; }
  // Forgets everything queued and any failure; a block download that is running is aborted.
  void clear();

  // Bytes of the running transfer so far.
  [[nodiscard]] std::size_t transferred() const { return client_.transferred(); }

  void receive(const hal::CanFrame& frame, std::uint64_t now_us);
  void poll(std::uint64_t now_us);
  [[nodiscard]] bool offer(hal::CanFrame& frame);
  void taken() { outgoing_ = false; }

 private:
  struct Job {
    canopen::ObjectId object;
    Bytes bytes;
    bool writing = true;
    std::string what;
    OnDone written;
    OnRead read;
  };
  void advance(std::uint64_t now_us);
  void keep_last_word();

  std::uint8_t node_;
  std::uint64_t timeout_us_ = canopen::kSdoTimeout_us;
  canopen::SdoClient client_;
  std::deque<Job> jobs_;
  bool started_ = false;
  bool outgoing_ = false;
  canopen::SdoData request_{};
  std::string failure_;
  canopen::AbortCode abort_code_ = canopen::AbortCode::none;
  bool refused_ = false;
  canopen::ObjectId failed_;
};

}  // namespace volcomp::host
