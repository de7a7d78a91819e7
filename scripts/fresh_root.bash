# Sourced by scripts/prove_*: a minimal Debian 12 in a folder, to show there what a new user would see.
# Needs root, debootstrap and a kernel that lets it mount. The root gets this machine's apt and pip configuration,
# certificates and proxy settings, and nothing else of it.
suite=bookworm

# enter_namespace ARGUMENTS...: from the checkout, starts the script again where its mounts vanish with it, whatever happens.
enter_namespace() {
  [ "$(id -u)" = 0 ] || { echo "$(basename "$0"): needs root (debootstrap, chroot)" >&2; exit 1; }
  [ -n "${IN_NAMESPACE:-}" ] || IN_NAMESPACE=1 exec unshare --mount --pid --fork --kill-child "scripts/$(basename "$0")" "$@"
}

mirror() {  # where this machine gets Debian from
  apt-get indextargets --format '$(REPO_URI) $(RELEASE) $(COMPONENT)' | awk '$2 ~ /^bookworm/ && $3 == "main" {print $1; exit}'
}

# make_root FOLDER PACKAGES: sets $root. FOLDER/root.tar keeps the bare system for the next time.
make_root() {
  local folder=$1 packages=$2
  root=$folder/root
  mkdir -p "$folder"
  rm -rf "$root"
  if [ ! -e "$folder/root.tar" ]; then
    echo "== minimal Debian ($suite) with $packages from this machine's mirror"
    debootstrap --variant=minbase --include="$packages" "$suite" "$root" "$(mirror)" >"$folder/debootstrap.log" \
      || { tail -n 20 "$folder/debootstrap.log" >&2; exit 1; }
    tar -C "$root" -cf "$folder/root.tar.new" . && mv "$folder/root.tar.new" "$folder/root.tar"
  else
    mkdir "$root"
    tar -C "$root" -xf "$folder/root.tar"
  fi
  copy_configuration
  mount --make-rprivate /
  mount -t proc proc "$root/proc"
  mount --rbind /dev "$root/dev"
  mount -t tmpfs tmpfs "$root/tmp"
}

copy_configuration() {
  rm -rf "$root/etc/apt/sources.list" "$root/etc/apt/sources.list.d"
  mkdir "$root/etc/apt/sources.list.d"
  local path
  for path in /etc/apt/sources.list /etc/apt/sources.list.d/*.sources /etc/apt/sources.list.d/*.list /etc/apt/apt.conf.d \
      /etc/apt/auth.conf.d /etc/apt/trusted.gpg.d /etc/apt/keyrings /usr/share/keyrings /etc/pip.conf \
      /etc/ssl/certs/ca-certificates.crt /etc/resolv.conf /etc/hosts; do
    [ ! -e "$path" ] || cp -aL --parents "$path" "$root"
  done
}

# set_environment LOGIN: what programs inside see, in $environment.
set_environment() {
  local line
  environment=(HOME=/root USER="$1" LANG=C.UTF-8 PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin TERM=dumb)
  while IFS= read -r line; do
    environment+=("$line")
  done < <(env | grep -vi '^pip_find_links=' | grep -iE '^(pip_[a-z_]*|[a-z]*_proxy|ssl_cert_[a-z]*|requests_ca_bundle|curl_ca_bundle)=')
}

inside() { env -i "${environment[@]}" chroot "$root" "$@" </dev/null; }
