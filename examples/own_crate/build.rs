fn main() {
    dalembert_build::models();
}
