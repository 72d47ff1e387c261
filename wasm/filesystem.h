#pragma once
// What libc++ leaves out where there is no file system: the module reads memory only, so nothing exists.

#include <cstdint>
#include <filesystem>
#include <system_error>

_LIBCPP_BEGIN_NAMESPACE_FILESYSTEM

inline bool exists(const path&) {
    return false;
}
inline bool exists(const path&, error_code& code) {
    code.clear();
    return false;
}
inline bool is_directory(const path&, error_code& code) {
    code.clear();
    return false;
}
inline std::uintmax_t file_size(const path&, error_code& code) {
    code = make_error_code(errc::no_such_file_or_directory);
    return 0;
}
class directory_entry {
  public:
    const filesystem::path& path() const { return path_; }
    bool is_regular_file(error_code&) const { return false; }

  private:
    filesystem::path path_;
};
class directory_iterator {
  public:
    directory_iterator() = default;
    directory_iterator(const path&, error_code& code) { code.clear(); }
    const directory_entry& operator*() const { return entry_; }
    const directory_entry* operator->() const { return &entry_; }
    directory_iterator& increment(error_code&) { return *this; }
    friend bool operator==(const directory_iterator&, const directory_iterator&) { return true; }

  private:
    directory_entry entry_;
};

_LIBCPP_END_NAMESPACE_FILESYSTEM
