// Spans of time, for the timeline and the stage statistics. Stages know only the interface: they open a `Span`
// around a piece of work and cannot read the clock, so time never decides anything.
#pragma once

namespace vsgraphs {

class TraceSink {
 public:
  virtual ~TraceSink() = default;
  // `name` is a string literal. Calls nest and come from one thread per sink.
  virtual void begin(const char* name) = 0;
  virtual void end() = 0;
};

class Span {
 public:
  Span(TraceSink* sink, const char* name) : sink_(sink) {
    if (sink_) sink_->begin(name);
  }
  ~Span() {
    if (sink_) sink_->end();
  }
  Span(const Span&) = delete;
  Span& operator=(const Span&) = delete;

 private:
  TraceSink* sink_;
};

}  // namespace vsgraphs
