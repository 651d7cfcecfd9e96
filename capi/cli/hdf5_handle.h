// Owns an identifier of the HDF5 library.
//
// Begin with start_hdf5(): failures are told by our own messages, and the library does not clean up at exit, where it
// crashes after a write that failed on a full disk (1.10). Everything is closed by its owner before.
#pragma once

#include <hdf5.h>

#include <utility>

namespace brinell::cli {

inline void start_hdf5() {
  H5dont_atexit();
  H5Eset_auto(H5E_DEFAULT, nullptr, nullptr);
}

class Hdf5Handle {
 public:
  using Close = herr_t (*)(hid_t);

  Hdf5Handle(hid_t id, Close closer) : id_(id), close_(closer) {}
  Hdf5Handle(Hdf5Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Hdf5Handle& operator=(Hdf5Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Hdf5Handle() {
    if (id_ >= 0) close_(id_);
  }

  explicit operator bool() const { return id_ >= 0; }
  hid_t get() const { return id_; }

  /// Closes now; false if the library reports a failure.
  bool close() { return close_(std::exchange(id_, -1)) >= 0; }

 private:
  hid_t id_;
  Close close_;
};

}  // namespace brinell::cli
