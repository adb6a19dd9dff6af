// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// String, built on std::string.
#pragma once

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <string>

class __FlashStringHelper;
#define F(text) (reinterpret_cast<const __FlashStringHelper*>(text))

class String {
 public:
  String(const char* text = "") : text_(text == nullptr ? "" : text) {}
  String(const __FlashStringHelper* text) : text_(reinterpret_cast<const char*>(text)) {}
  explicit String(char c) : text_(1, c) {}
  explicit String(unsigned char value, int base = 10)
      : String(static_cast<unsigned long>(value), base) {}
  explicit String(int value, int base = 10) : String(static_cast<long>(value), base) {}
  explicit String(unsigned value, int base = 10)
      : String(static_cast<unsigned long>(value), base) {}
  explicit String(long value, int base = 10);
  explicit String(unsigned long value, int base = 10);
  explicit String(float value, int digits = 2) : String(static_cast<double>(value), digits) {}
  explicit String(double value, int digits = 2);

  unsigned length() const { return static_cast<unsigned>(text_.size()); }
  bool isEmpty() const { return text_.empty(); }
  const char* c_str() const { return text_.c_str(); }
  bool reserve(unsigned size) { return text_.reserve(size), true; }

  template <class Any>
  String& operator=(const Any& value) {
    return text_ = String(value).text_, *this;
  }
  template <class Any>
  String& operator+=(const Any& value) {
    return text_ += String(value).text_, *this;
  }
  String& operator+=(const String& other) { return text_ += other.text_, *this; }
  template <class Any>
  bool concat(const Any& value) {
    return *this += value, true;
  }
  template <class Any>
  friend String operator+(String left, const Any& right) {
    return left += right;
  }
  friend String operator+(const char* left, const String& right) { return String(left) += right; }
  friend String operator+(const __FlashStringHelper* left, const String& right) {
    return String(left) += right;
  }

  bool operator==(const String& other) const { return text_ == other.text_; }
  bool operator!=(const String& other) const { return text_ != other.text_; }
  bool operator<(const String& other) const { return text_ < other.text_; }
  bool operator>(const String& other) const { return text_ > other.text_; }
  bool operator<=(const String& other) const { return text_ <= other.text_; }
  bool operator>=(const String& other) const { return text_ >= other.text_; }
  bool equals(const String& other) const { return text_ == other.text_; }
  bool equalsIgnoreCase(const String& other) const {
    return strcasecmp(c_str(), other.c_str()) == 0;
  }
  int compareTo(const String& other) const { return strcmp(c_str(), other.c_str()); }
  bool startsWith(const String& start, unsigned from = 0) const {
    return from <= length() && text_.compare(from, start.length(), start.text_) == 0;
  }
  bool endsWith(const String& end) const {
    return end.length() <= length() && startsWith(end, length() - end.length());
  }

  char charAt(unsigned at) const { return at < length() ? text_[at] : '\0'; }
  void setCharAt(unsigned at, char c) {
    if (at < length()) text_[at] = c;
  }
  char operator[](unsigned at) const { return charAt(at); }
  char& operator[](unsigned at) {
    static char none;
    return at < length() ? text_[at] : none = '\0';
  }
  void toCharArray(char* into, unsigned size, unsigned from = 0) const {
    if (size > 0) snprintf(into, size, "%s", from < length() ? c_str() + from : "");
  }
  void getBytes(unsigned char* into, unsigned size, unsigned from = 0) const {
    toCharArray(reinterpret_cast<char*>(into), size, from);
  }

  int indexOf(char c, unsigned from = 0) const { return found(text_.find(c, from)); }
  int indexOf(const String& part, unsigned from = 0) const {
    return found(text_.find(part.text_, from));
  }
  int lastIndexOf(char c) const { return found(text_.rfind(c)); }
  int lastIndexOf(const String& part) const { return found(text_.rfind(part.text_)); }
  String substring(unsigned from) const { return substring(from, length()); }
  String substring(unsigned from, unsigned to) const;

  void replace(const String& wanted, const String& by);
  void replace(char wanted, char by) { replace(String(wanted), String(by)); }
  void remove(unsigned from, unsigned count = ~0U) {
    if (from < length()) text_.erase(from, count);
  }
  void toLowerCase();
  void toUpperCase();
  void trim();

  long toInt() const { return atol(c_str()); }
  float toFloat() const { return static_cast<float>(atof(c_str())); }
  double toDouble() const { return atof(c_str()); }

 private:
  static int found(size_t at) { return at == std::string::npos ? -1 : static_cast<int>(at); }
  std::string text_;
};
