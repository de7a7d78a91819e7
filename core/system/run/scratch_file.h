// A file without a name, for what is to be kept for as long as the program runs and is too large, in the long run, for memory.
#pragma once

#include <cstddef>
#include <memory>

namespace vsgraphs {

class ScratchFile {
 public:
  // In the folder for temporary files (TMPDIR, else /tmp); null where none can be made there. The system removes it when the
  // last who holds it is gone, however the program ends.
  static std::shared_ptr<ScratchFile> make();
  // Of an open descriptor, which it closes.
  explicit ScratchFile(int file) : file_(file) {}
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  // False where there is no room for it.
  bool write(std::size_t offset, const void* bytes, std::size_t size);
  // Any thread. Throws RunError if the file cannot be read.
  void read(std::size_t offset, void* bytes, std::size_t size) const;

 private:
  int file_;
};

}  // namespace vsgraphs
