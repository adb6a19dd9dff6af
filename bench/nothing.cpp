// Starts and ends.
int main() {
  return 0;
}
