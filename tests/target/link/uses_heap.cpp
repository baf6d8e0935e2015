int main() {
  volatile int* const number = new int(1);
  return *number;
}
